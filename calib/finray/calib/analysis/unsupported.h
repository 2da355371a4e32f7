#ifndef FINRAY_CALIB_ANALYSIS_UNSUPPORTED_H_
#define FINRAY_CALIB_ANALYSIS_UNSUPPORTED_H_

#include <vector>

#include "finray/calib/analysis/identifiability.h"
#include "finray/calib/problem/calibration_problem.h"
#include "finray/io/warning.h"

namespace finray {

/// Finds parameters with a good std that nobody should trust all the same.
/// Their status becomes kUnidentifiable. There is a warning for each dead gauge
/// and one for all parameters with the same other fault. Found are:
///  - The gain of a gauge that does not respond. Nothing is known of what such
///    a gauge would read. Its gain is zero within kInsignificant std, or its
///    ratio to the expected gain is below kDeadShare of that of the others.
///  - The offset of a gauge that has no reading free of contact, unless its
///    prior is knowledge. It is only what the model says that the unbent gauge
///    would read, and it takes up whatever the model lacks.
///  - A parameter x +- s whose prior m +- s_p the data contradict, and which
///    the prior has moved by more than s: |x - m| > kContradiction sqrt(s_p^2 -
///    s^2) and |x - m| s > s_p^2 - s^2. Here s is not enlarged for what
///    residuals show.
/// A parameter more than kFarFromPrior s_p from m that the data overrule keeps
/// its status, with a warning: the value stands, and the prior is wrong.
void FindUnsupported(CalibrationProblem& problem, Identifiability* found,
                     std::vector<Warning>* warnings);
constexpr double kInsignificant = 4, kDeadShare = 0.01, kContradiction = 5,
                 kFarFromPrior = 4;

}  // namespace finray

#endif  // FINRAY_CALIB_ANALYSIS_UNSUPPORTED_H_
