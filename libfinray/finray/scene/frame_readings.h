#ifndef FINRAY_SCENE_FRAME_READINGS_H_
#define FINRAY_SCENE_FRAME_READINGS_H_

#include <limits>
#include <vector>

namespace finray {

/// What was measured in one frame; NaN where it was not.
struct FrameReadings {
  std::vector<double> gauges_V;  ///< One per gauge of the finger.
  /// The object's own frame in frame S, as a stage or a camera tells it. Used
  /// where the scene says how well it is known.
  double object_x_mm = std::numeric_limits<double>::quiet_NaN();
  double object_y_mm = std::numeric_limits<double>::quiet_NaN();
  double object_angle_rad = 0;
};

}  // namespace finray

#endif  // FINRAY_SCENE_FRAME_READINGS_H_
