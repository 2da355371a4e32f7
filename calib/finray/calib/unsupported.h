#ifndef FINRAY_CALIB_UNSUPPORTED_H_
#define FINRAY_CALIB_UNSUPPORTED_H_

#include <string>
#include <vector>

#include "finray/calib/calibration_problem.h"
#include "finray/calib/identifiability.h"

namespace finray {

/// Parameters whose std look good, and which still nobody should trust.
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
/// - A parameter whose prior the data contradict, x being further from its
///   mean m than kContradiction prior std s_p, and which it has drawn away from
///   what they say by more than their std s: s |x - m| / s_p^2 > 1.
std::vector<Unsupported> FindUnsupported(CalibrationProblem& problem,
                                         const Identifiability& found);
constexpr double kInsignificant = 4, kDeadShare = 0.01, kContradiction = 5;

}  // namespace finray

#endif  // FINRAY_CALIB_UNSUPPORTED_H_
