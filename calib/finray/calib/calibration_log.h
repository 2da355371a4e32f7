#ifndef FINRAY_CALIB_CALIBRATION_LOG_H_
#define FINRAY_CALIB_CALIBRATION_LOG_H_

#include <Eigen/Core>
#include <string>
#include <vector>

#include "finray/calib/plan.h"
#include "finray/finger/finger.h"

namespace finray {

/// One row of a log, NaN for what was not measured.
struct CalibrationFrame {
  int log = 0;  ///< which log, and which of its rows (from 0)
  int row = 0;
  double time_s;
  bool contact = false;   ///< touches the object; else it is a free frame
  bool held_out = false;  ///< kept from the fit
  std::vector<double> gauges_V;
  double force_N;
  Eigen::Vector2d force_xy_N;
  Eigen::Vector2d object_mm;
  double contact_mm;
};

/// All logs of a calibration.
struct CalibrationLogs {
  std::vector<std::string> paths;
  std::vector<CalibrationFrame> frames;
};

/// Reads the logs and decides, row by row, whether the finger touches:
///  - where a reference force was measured, by its being above 3 std;
///  - else where the object's centre was, by its reaching into the undeformed
///    finger by more than 3 std;
///  - else by a contact location being there;
///  - else yes.
/// The scene's `contacts: 0` or `1` overrides that. Marks the held-out frames.
/// Throws InputError for a missing gauge column and for logs with too little in
/// them to hold anything out.
CalibrationLogs ReadCalibrationLogs(const std::vector<std::string>& paths,
                                    const Finger& finger, const Plan& plan);

}  // namespace finray

#endif  // FINRAY_CALIB_CALIBRATION_LOG_H_
