#ifndef FINRAY_CALIB_ANALYSIS_NEXT_FRAMES_H_
#define FINRAY_CALIB_ANALYSIS_NEXT_FRAMES_H_

#include <string>
#include <vector>

#include "finray/calib/analysis/identifiability.h"
#include "finray/calib/problem/calibration_problem.h"
#include "finray/calib/solve/robust_solve.h"

namespace finray {

/// Predicts what to record next. S and P are those of the logs
/// (Identifiability). J holds the derivatives of the residuals of one more
/// frame, which the calibrated finger predicts, with its contact eliminated. n
/// such frames leave the covariance
///
///   C' = (S + P + n J'J)^-1.
///
/// The candidates are free frames and contact frames at several heights and
/// loads, all at one height or spread over all heights. Contact frames have the
/// measurements of the logs, alone or with those that the logs lack (force,
/// centre of the object, contact location). A candidate is judged by the std
/// along a weak direction v: sqrt(v' C' v) against sqrt(v' C v).
struct FrameAdvice {
  static constexpr int kFrames = 20;

  bool free = false;
  /// The advice is not to record frames but to find the gains elsewhere, where
  /// gains and other parameters move together.
  bool known_gains = false;
  double contact_mm = 0;  ///< NaN if the frames spread over all heights.
  double normal_N = 0;
  /// The measurements that the logs do not have.
  std::vector<ResidualFamily> added;
  double std_before = 0, std_after = 0;  ///< Along v, in units of the priors.
  /// The std of the parameter with the largest share in v, in its unit. It is
  /// infinite if the data say nothing and there is no prior.
  int parameter = 0;  ///< Index into CalibrationParameters::all().
  double parameter_std_before = 0, parameter_std_after = 0;
  std::string words;

  double ratio() const { return std_after / std_before; }
};

/// Says the advice in words, e.g. "20 frames at 98 mm with 6 N would shrink the
/// std of front stiffness from 12 % to 4 %".
std::string DescribeNextFrames(CalibrationProblem& problem,
                               const FrameAdvice& advice);

/// Returns the advice on the worst direction. Sets the remedy of each weak
/// direction to the first line of the advice on it.
std::vector<FrameAdvice> AdviseNextFrames(CalibrationProblem* problem,
                                          const CalibrationSolution& solution,
                                          Identifiability* found);

}  // namespace finray

#endif  // FINRAY_CALIB_ANALYSIS_NEXT_FRAMES_H_
