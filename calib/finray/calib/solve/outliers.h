#ifndef FINRAY_CALIB_SOLVE_OUTLIERS_H_
#define FINRAY_CALIB_SOLVE_OUTLIERS_H_

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "finray/calib/problem/calibration_problem.h"
#include "finray/calib/solve/contact_store.h"
#include "finray/calib/solve/linearization.h"

namespace finray {

/// Frames that the solution does not explain, by index, and the reason.
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
  /// A share of the frames. If more stand out, the model or the std are wrong.
  static constexpr double kMostShare = 0.25;

  std::map<int, std::string> reasons;
  bool too_many = false;  ///< reasons are then empty
  double scale = 1;       ///< s
  /// The linearization of the frames that FindOutliersAmong does not reject by
  /// the scale it was given.
  std::optional<Linearization> rest;
};

/// Judges all frames at the solution; rejected ones are judged anew.
Outliers FindOutliers(const Linearization& at_solution,
                      CalibrationProblem* problem, ContactStore* contacts);
/// Judges these frames on the way to the solution.
Outliers FindOutliersAmong(const std::vector<int>& frames,
                           double expected_scale, CalibrationProblem* problem,
                           ContactStore* contacts);

}  // namespace finray

#endif  // FINRAY_CALIB_SOLVE_OUTLIERS_H_
