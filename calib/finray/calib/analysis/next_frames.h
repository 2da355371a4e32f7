#ifndef FINRAY_CALIB_ANALYSIS_NEXT_FRAMES_H_
#define FINRAY_CALIB_ANALYSIS_NEXT_FRAMES_H_

#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "finray/calib/analysis/identifiability.h"
#include "finray/calib/analysis/predicted_frames.h"
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
/// centre of the object, contact location). If the data leave weak directions,
/// a candidate is judged by the std along the weakest, v: sqrt(v' C' v) against
/// sqrt(v' C v). Else it is judged by what the calibration adds to the std of
/// the forces that the gauges sense (PredictedForce).
struct FrameAdvice {
  static constexpr int kFrames = 20;

  bool free = false;
  /// The advice is not to record frames but to find the gains elsewhere, where
  /// gains and other parameters move together.
  bool known_gains = false;
  double contact_mm = 0;  ///< NaN if the frames spread over all heights.
  double normal_N = 0;
  /// Where the stage has the circle for it, as the logs count object_x_mm and
  /// object_y_mm: one place, or one for each height. Empty without a circle.
  std::vector<Eigen::Vector2d> object_mm;
  /// The measurements that the logs do not have.
  std::vector<ResidualFamily> added;
  /// Along v, in units of the priors; or what the calibration adds to the std
  /// of a force, in N.
  double std_before = 0, std_after = 0;
  /// If the force decided, its predicted std with the noise of a frame.
  std::optional<double> force_std_before_N, force_std_after_N;
  /// The std of the parameter with the largest share in v, or in the std of the
  /// force, in its unit. It is infinite if the data say nothing and there is no
  /// prior.
  int parameter = 0;  ///< Index into CalibrationParameters::all().
  double parameter_std_before = 0, parameter_std_after = 0;
  std::string words;

  double ratio() const { return std_after / std_before; }
};

/// Says the advice in words, e.g. "20 frames at 98 mm with 6 N would shrink the
/// std of front stiffness from 12 % to 4 %".
std::string DescribeNextFrames(CalibrationProblem& problem,
                               const FrameAdvice& advice);

/// Says which frames to record next, and whether more of them are worth it.
struct NextRecording {
  std::vector<FrameAdvice> advice;  ///< The best one first.
  /// The parts of the predicted std of a force (PredictedForce), and over how
  /// many contacts. NaN if the gauges determine no contact, or if the data and
  /// priors say nothing along a direction.
  double force_calibration_N = std::numeric_limits<double>::quiet_NaN();
  double force_noise_N = std::numeric_limits<double>::quiet_NaN();
  std::size_t force_contacts = 0;
  /// No direction is weak, and the calibration adds no more to the variance of
  /// a force than the noise of one frame does.
  bool enough = false;

  double force_std_N() const {
    return std::hypot(force_calibration_N, force_noise_N);
  }
};
/// Says in words whether enough is recorded, or what to record.
std::string NextWords(const NextRecording& next);

/// Returns the advice on the worst direction, or on the force if none is weak.
/// Sets the remedy of each weak direction to the first line of the advice on
/// it.
NextRecording AdviseNextFrames(CalibrationProblem* problem,
                               const CalibrationSolution& solution,
                               Identifiability* found);

}  // namespace finray

#endif  // FINRAY_CALIB_ANALYSIS_NEXT_FRAMES_H_
