#ifndef FINRAY_CALIB_SOLVE_OUTLIERS_H_
#define FINRAY_CALIB_SOLVE_OUTLIERS_H_

#include <map>
#include <string>
#include <vector>

#include "finray/calib/problem/calibration_problem.h"

namespace finray {

/// Frames that the solution does not explain, by index, and what does not fit.
/// With c_t the chi2 of frame t, without the weights of the robust loss, over
/// its n_t measurements, two of which a contact takes,
///
///   s^2 = median(c_t / median of chi2 with n_t - 2 degrees of freedom),
///
/// at least 1, says how well the others are explained, and frame t is an
/// outlier if P(chi2 > c_t / s^2) < kFalseAlarms / frames. So a model that fits
/// nowhere well rejects nothing for it.
struct Outliers {
  static constexpr double kFalseAlarms = 0.01;  ///< expected in a log
  /// Of the frames. More are no outliers: the model or the std are wrong.
  static constexpr double kMostShare = 0.25;

  std::map<int, std::string> reasons;
  bool too_many = false;  ///< reasons are then empty
  double scale = 1;       ///< s
};

/// Of all frames, at the solution; those that are rejected already are judged
/// anew.
Outliers FindOutliers(CalibrationProblem* problem);
/// Of these frames, on the way to it. The others are summed up on the way, as
/// far as they can be told by the scale that is expected.
Outliers FindOutliersAmong(const std::vector<int>& frames,
                           double expected_scale, CalibrationProblem* problem);

}  // namespace finray

#endif  // FINRAY_CALIB_SOLVE_OUTLIERS_H_
