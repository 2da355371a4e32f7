#include "finray/finger/geometry.h"

#include <cmath>
#include <limits>

namespace finray {

double BeamLength(const Finger& finger, Side side) {
  return side == Side::kFront
             ? finger.front_length_mm
             : finger.front_length_mm / std::sin(finger.back_angle_rad);
}

Eigen::Vector2d BeamBase(const Finger& finger, Side side) {
  if (side == Side::kFront) return {0, 0};
  return {-finger.front_length_mm / std::tan(finger.back_angle_rad), 0};
}

double BeamAngle(const Finger& finger, Side side) {
  return side == Side::kFront ? M_PI / 2 : finger.back_angle_rad;
}

Eigen::Vector2d UndeformedPoint(const Finger& finger, Side side,
                                double arc_mm) {
  // The front beam lies on x = 0 exactly, which cos(pi/2) would miss.
  if (side == Side::kFront) return {0, arc_mm};
  const double angle = finger.back_angle_rad;
  return BeamBase(finger, side) +
         arc_mm * Eigen::Vector2d(std::cos(angle), std::sin(angle));
}

double RibBackArc(const Finger& finger, double front_mm, double angle_rad) {
  // (0, front) + d (cos, sin)(angle) = base + s (cos, sin)(phi): crossing both
  // sides with (cos, sin)(angle) leaves s.
  const Eigen::Vector2d base = BeamBase(finger, Side::kBack);
  const double c = std::cos(angle_rad), s = std::sin(angle_rad);
  const double cross =
      c * std::sin(finger.back_angle_rad) - s * std::cos(finger.back_angle_rad);
  if (std::abs(cross) < 1e-12) return std::numeric_limits<double>::quiet_NaN();
  return (c * (front_mm - base.y()) + s * base.x()) / cross;
}

double NominalRibLength(const Finger& finger, const Rib& rib) {
  return (UndeformedPoint(finger, Side::kBack, rib.back_mm) -
          UndeformedPoint(finger, Side::kFront, rib.front_mm))
      .norm();
}

double ForceUnit(const Finger& finger) {
  return std::sqrt(finger.front_stiffness_N_mm2 * finger.back_stiffness_N_mm2) /
         (finger.front_length_mm * finger.front_length_mm);
}

}  // namespace finray
