#ifndef FINRAY_TESTS_PERCEPTION_TOUCH_FIXTURE_H_
#define FINRAY_TESTS_PERCEPTION_TOUCH_FIXTURE_H_

#include <cmath>
#include <vector>

#include "finray/objects/outline.h"
#include "finray/perception/contact_sensor.h"

namespace finray {

/// An exact touch of a beam that is bent around the outline with a radius of
/// 600 mm. Its covariance has the given std.
inline Touch ExactTouch(const Outline& outline, double normal_angle_rad,
                        double std_mm = 0.02, double std_rad = 5e-4) {
  constexpr double kBeamRadius_mm = 600, kHalf_mm = 40;
  Touch touch{};
  touch.point_mm = outline.PointAt(normal_angle_rad).position_mm;
  touch.normal_angle_rad = std::remainder(normal_angle_rad, 2 * M_PI);
  touch.normal_N = 3;
  touch.covariance =
      Eigen::Vector3d(std_mm * std_mm, std_mm * std_mm, std_rad * std_rad)
          .asDiagonal();
  const Eigen::Vector2d n = touch.Normal();
  // From base to tip, with the finger (the side of n) on the right.
  const Eigen::Vector2d t(-n.y(), n.x());
  for (int i = 0; i <= 160; ++i) {
    const double s = -kHalf_mm + 2 * kHalf_mm * i / 160;
    touch.beam_mm.push_back(touch.point_mm + s * t -
                            s * s / (2 * kBeamRadius_mm) * n);
  }
  touch.contact_arc_mm = kHalf_mm;
  touch.beam_length_mm = 2 * kHalf_mm;
  return touch;
}

inline std::vector<Touch> ExactTouches(const Outline& outline, int count,
                                       double first_rad = 0.05) {
  std::vector<Touch> touches;
  for (int i = 0; i < count; ++i) {
    touches.push_back(ExactTouch(outline, first_rad + 2 * M_PI * i / count));
    touches.back().row = static_cast<std::size_t>(i);
  }
  return touches;
}

}  // namespace finray

#endif  // FINRAY_TESTS_PERCEPTION_TOUCH_FIXTURE_H_
