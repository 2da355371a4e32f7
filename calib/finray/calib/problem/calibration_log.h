#ifndef FINRAY_CALIB_PROBLEM_CALIBRATION_LOG_H_
#define FINRAY_CALIB_PROBLEM_CALIBRATION_LOG_H_

#include <Eigen/Core>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "finray/calib/problem/plan.h"
#include "finray/finger/finger.h"

namespace finray {

/// A rib's hinge on one of the beams, seen by a camera.
struct SeenPin {
  int rib;
  Side side;
  Eigen::Vector2d at_mm;
};

/// One row of a log, NaN for what was not measured.
struct CalibrationFrame {
  static constexpr double kNotMeasured =
      std::numeric_limits<double>::quiet_NaN();
  int log = 0;  ///< which log, and which of its rows (from 0)
  int row = 0;
  double time_s = kNotMeasured;
  bool contact = false;   ///< touches the object; else it is a free frame,
                          ///< or no frame of the finger but of the bench
  bool held_out = false;  ///< kept from the fit
  std::vector<double> gauges_V;
  double force_N = kNotMeasured;
  Eigen::Vector2d force_xy_N{kNotMeasured, kNotMeasured};
  Eigen::Vector2d object_mm{kNotMeasured, kNotMeasured};
  double contact_mm = kNotMeasured;
  double temperature_C = kNotMeasured;
  /// Only where the plan says how good they are.
  std::vector<SeenPin> pins;
  Eigen::Vector2d tip_mm{kNotMeasured, kNotMeasured};
  /// Of the cylinder round which the gauges were bent on the bench, apart from
  /// the finger.
  double cylinder_radius_mm = kNotMeasured;

  bool IsBench() const { return !std::isnan(cylinder_radius_mm); }
};

/// All logs of a calibration.
struct CalibrationLogs {
  std::vector<std::string> paths;
  /// Their file names, or as much more of the paths as tells them apart.
  std::vector<std::string> names;
  std::vector<CalibrationFrame> frames;

  /// By log, whether every row of it is held out.
  std::vector<bool> HeldOut() const;
};

/// Reads the logs and decides, row by row, whether the finger touches:
///  - where a reference force was measured, by its being above 3 std;
///  - else where the object's centre was, by its reaching into the undeformed
///    finger by more than 3 std;
///  - else by a contact location being there;
///  - else yes.
/// With an unknown offset of the force sensor the object comes first, and the
/// force counts from 3 times what its std and the offset's prior leave
/// together. The scene's `contacts: 0` or `1` overrides all that.
///
/// Rows with a cylinder_radius_mm are of the bench. A row without time or
/// temperature, where the plan needs it, has that of the row before: both are
/// slow. Marks the held-out frames. Throws InputError for a missing gauge
/// column (a log with none at all may have pins instead), for a parameter that
/// is free without the column that it needs, and for logs with too little in
/// them to hold anything out.
CalibrationLogs ReadCalibrationLogs(const std::vector<std::string>& paths,
                                    const Finger& finger, const Plan& plan);

}  // namespace finray

#endif  // FINRAY_CALIB_PROBLEM_CALIBRATION_LOG_H_
