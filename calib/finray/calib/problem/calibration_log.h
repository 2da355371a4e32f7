#ifndef FINRAY_CALIB_PROBLEM_CALIBRATION_LOG_H_
#define FINRAY_CALIB_PROBLEM_CALIBRATION_LOG_H_

#include <Eigen/Core>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "finray/calib/problem/plan.h"
#include "finray/scene/measurements.h"

namespace finray {

/// One row of a log. A saturated gauge reads NaN; pins and tip are there only
/// where the plan gives their std.
struct CalibrationFrame : Measurements {
  int log = 0;            ///< which log
  int row = 0;            ///< which of its rows, from 0
  bool contact = false;   ///< The finger touches the object. If not, this is a
                          ///< free frame or a row of the bench.
  bool held_out = false;  ///< kept from the fit
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
