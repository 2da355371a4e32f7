#ifndef FINRAY_CALIB_ANALYSIS_STAGE_FIT_H_
#define FINRAY_CALIB_ANALYSIS_STAGE_FIT_H_

#include <Eigen/Core>
#include <vector>

#include "finray/calib/problem/calibration_log.h"
#include "finray/calib/problem/plan.h"
#include "finray/finger/finger.h"
#include "finray/statics/equilibrium.h"

namespace finray {

/// Where the stage of one log has its origin, in frame S, and how it is turned;
/// with std.
struct FittedStage {
  int log;  ///< Index of the log.
  Eigen::Vector2d origin_mm, origin_std_mm;
  double rotation_deg = 0, rotation_std_deg = 0;
  /// The largest of these over the std of its prior; 0 without priors.
  double over_prior = 0;
};

/// Aligns the places of the object in logs whose stage was set up anew. It fits
/// the origin of each log, and its rotation if the plan frees that, to all
/// measurements of the log with a finger that stays as it is; the plan's priors
/// and loss count. Then it takes the places of these logs to frame S. What is
/// left there is error of the finger.
///
/// Returns the logs that were aligned: none if the plan does not free
/// object_origin, its scene has no circle, the fit fails or does not converge,
/// or it leaves too many frames unexplained
/// (CalibrationSolution::outliers_too_many) or residuals of more than 5 std
/// rms. A log with fewer than kFewestAligned places of a touching object stays
/// as it is.
std::vector<FittedStage> AlignStages(const Finger& finger, const Plan& plan,
                                     const Discretization& discretization,
                                     int threads, CalibrationLogs* logs);
constexpr int kFewestAligned = 10;

}  // namespace finray

#endif  // FINRAY_CALIB_ANALYSIS_STAGE_FIT_H_
