#ifndef FINRAY_TESTS_STATICS_RIB_ENDS_H_
#define FINRAY_TESTS_STATICS_RIB_ENDS_H_

#include <Eigen/Core>
#include <array>
#include <cmath>

#include "finray/finger/geometry.h"
#include "finray/statics/shape.h"

namespace finray {

inline Eigen::Vector2d PointOf(const Section& section) {
  return {section.x_mm, section.y_mm};
}

/// What the beam does to the rib at an end, read from the jump there, and the
/// turn of the beam.
struct RibEndLoad {
  Eigen::Vector2d at, force;
  double moment, turn;
};

inline RibEndLoad ReadRibEnd(const Shape& shape, const Finger& finger, int rib,
                             Side side) {
  constexpr double kBeside_mm = 1e-7;
  const double arc = side == Side::kFront ? finger.ribs[rib].front_mm
                                          : finger.ribs[rib].back_mm;
  const Section before = shape.At(side, arc - kBeside_mm),
                behind = shape.At(side, arc + kBeside_mm);
  return {PointOf(shape.At(side, arc)),
          {behind.force_x_N - before.force_x_N,
           behind.force_y_N - before.force_y_N},
          behind.moment_N_mm - before.moment_N_mm,
          shape.At(side, arc).theta_rad - BeamAngle(finger, side)};
}

inline double DirectionOf(const Eigen::Vector2d& r) {
  return std::atan2(r.y(), r.x());
}

inline double RestDirection(const Finger& finger, int rib) {
  return DirectionOf(
      UndeformedPoint(finger, Side::kBack, finger.ribs[rib].back_mm) -
      UndeformedPoint(finger, Side::kFront, finger.ribs[rib].front_mm));
}

/// The turns of both ends of a rib, which its springs have.
inline std::array<double, 2> RibTurns(const Shape& shape, const Finger& finger,
                                      int rib) {
  const RibEndLoad front = ReadRibEnd(shape, finger, rib, Side::kFront),
                   back = ReadRibEnd(shape, finger, rib, Side::kBack);
  const double swing =
      DirectionOf(back.at - front.at) - RestDirection(finger, rib);
  return {front.turn - swing, back.turn - swing};
}

}  // namespace finray

#endif  // FINRAY_TESTS_STATICS_RIB_ENDS_H_
