#ifndef FINRAY_CALIB_ANALYSIS_UNSUPPORTED_H_
#define FINRAY_CALIB_ANALYSIS_UNSUPPORTED_H_

#include <string>
#include <vector>

#include "finray/calib/analysis/identifiability.h"
#include "finray/calib/problem/calibration_problem.h"

namespace finray {

/// Parameters whose std look good and that nobody should trust all the same.
struct Unsupported {
  std::vector<int> free;  ///< indices into CalibrationParameters::free()
  std::string code, text, remedy;
};

/// - The gain of a gauge that does not respond: nothing is known of what it
///   would read. Its gain is zero within kInsignificant std, or, over what it
///   was expected to be, below kDeadShare of the others'.
/// - The offset of a gauge without any reading free of contact, unless its
///   prior is knowledge: it is then the model's word for what the gauge would
///   read unbent, and takes up whatever the model lacks.
/// - A parameter x +- s (not enlarged for what residuals show) whose prior m +-
/// s_p the data contradict and which has
///   moved it by more than s:
///     |x - m| > kContradiction sqrt(s_p^2 - s^2),  |x - m| s > s_p^2 - s^2.
std::vector<Unsupported> FindUnsupported(CalibrationProblem& problem,
                                         const Identifiability& found);
constexpr double kInsignificant = 4, kDeadShare = 0.01, kContradiction = 5;

}  // namespace finray

#endif  // FINRAY_CALIB_ANALYSIS_UNSUPPORTED_H_
