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

double BendingStiffness(const Finger& finger, Side side) {
  return side == Side::kFront ? finger.front_stiffness_N_mm2
                              : finger.back_stiffness_N_mm2;
}

double BendingStiffness(const Finger& finger, Side side, double arc_mm) {
  double ratio = 1;
  for (const StiffnessPiece& piece : Pieces(finger, side)) {
    ratio = piece.stiffness_ratio;
    if (arc_mm < piece.end_mm) break;
  }
  return ratio * BendingStiffness(finger, side);
}

double AxialStiffness(const Finger& finger, Side side) {
  return side == Side::kFront ? finger.front_axial_stiffness_N
                              : finger.back_axial_stiffness_N;
}

double ClampCompliance(const Finger& finger, Side side) {
  return side == Side::kFront ? finger.front_clamp_rad_per_N_mm
                              : finger.back_clamp_rad_per_N_mm;
}

double SurfaceOffset(const Finger& finger, Side side) {
  return side == Side::kFront ? finger.front_surface_mm
                              : finger.back_surface_mm;
}

bool Stretches(const Finger& finger) {
  return std::isfinite(finger.front_axial_stiffness_N) ||
         std::isfinite(finger.back_axial_stiffness_N);
}

const std::vector<StiffnessPiece>& Pieces(const Finger& finger, Side side) {
  return side == Side::kFront ? finger.front_pieces : finger.back_pieces;
}

double RibBackArc(const Finger& finger, double front_mm, double angle_rad) {
  // (0, front) + d (cos, sin)(angle) = base + s (cos, sin)(phi). The cross
  // product of both sides with one direction leaves the distance along the
  // other.
  const Eigen::Vector2d to_base =
      BeamBase(finger, Side::kBack) - Eigen::Vector2d(0, front_mm);
  const auto cross = [](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    return a.x() * b.y() - a.y() * b.x();
  };
  const Eigen::Vector2d rib(std::cos(angle_rad), std::sin(angle_rad));
  const Eigen::Vector2d back(std::cos(finger.back_angle_rad),
                             std::sin(finger.back_angle_rad));
  const double divisor = cross(rib, back);
  if (std::abs(divisor) < 1e-12 || cross(to_base, back) / divisor < 0) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  return cross(to_base, rib) / divisor;
}

double HingePlace(const Rib& rib, Side side) {
  return side == Side::kFront ? rib.front_mm : rib.back_mm;
}

const Rib* FirstBendingRib(const Finger& finger) {
  for (const Rib& rib : finger.ribs) {
    if (rib.Bends()) return &rib;
  }
  return nullptr;
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
