#ifndef FINRAY_TESTS_CALIB_TURNED_STAGE_H_
#define FINRAY_TESTS_CALIB_TURNED_STAGE_H_

#include <Eigen/Geometry>
#include <cmath>
#include <string>

#include "calib/standard_log.h"

namespace finray {

/// The standard log as a stage reads it whose axes are turned.
inline std::string TurnedStageLog(const TempFolder& folder, unsigned seed,
                                  double deg) {
  FrameTable log = FrameTable::Read(StandardLog(folder, HiddenFinger(), seed));
  std::vector<double>& x = log.MutableNumbers("object_x_mm");
  std::vector<double>& y = log.MutableNumbers("object_y_mm");
  const Eigen::Rotation2Dd turn(-deg * M_PI / 180);
  for (std::size_t i = 0; i < log.rows(); ++i) {
    const Eigen::Vector2d seen = turn * Eigen::Vector2d(x[i], y[i]);
    x[i] = seen.x();
    y[i] = seen.y();
  }
  log.Write(folder.Path("turned.csv"));
  return folder.Path("turned.csv");
}

}  // namespace finray

#endif  // FINRAY_TESTS_CALIB_TURNED_STAGE_H_
