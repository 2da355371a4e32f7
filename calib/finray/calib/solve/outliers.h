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

/// The frames that the solution does not explain, by index, and the reason. c_t
/// is the chi2 of frame t without the weights of the robust loss, over its n_t
/// measurements, of which a contact uses up two. The scale
///
///   s^2 = median(c_t / median of chi2 with n_t - 2 degrees of freedom),
///
/// but at least 1, says how well most frames are explained. Frame t is an
/// outlier if P(chi2 > c_t / s^2) < kFalseAlarms / frames. So if a model fits
/// nowhere well, no frame is rejected for it.
struct Outliers {
  /// The number of false alarms that are expected.
  static constexpr double kFalseAlarms = 0.01;
  /// The largest share of outliers. If more frames stand out, the model or the
  /// std are wrong.
  static constexpr double kMostShare = 0.25;

  std::map<int, std::string> reasons;
  bool too_many = false;  ///< More than kMostShare; `reasons` is then empty.
  double scale = 1;       ///< s.
  /// The linearization of the good frames. They are good by the scale that was
  /// known before, so that one pass is enough.
  std::optional<Linearization> rest;
};

/// Judges all frames at the solution. Rejected frames are judged anew.
Outliers FindOutliers(const Linearization& at_solution,
                      CalibrationProblem* problem, ContactStore* contacts);
/// Judges these frames on the way to the solution.
Outliers FindOutliersAmong(const std::vector<int>& frames,
                           double expected_scale, CalibrationProblem* problem,
                           ContactStore* contacts);

}  // namespace finray

#endif  // FINRAY_CALIB_SOLVE_OUTLIERS_H_
