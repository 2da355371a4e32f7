#ifndef FINRAY_PERCEPTION_FORCE_DISPLACEMENT_H_
#define FINRAY_PERCEPTION_FORCE_DISPLACEMENT_H_

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "finray/io/frame_table.h"
#include "finray/objects/outline.h"
#include "finray/perception/contact_sensor.h"

namespace finray {

/// An object that yields along a line, as a finger pressed against it senses
/// it. With e the direction in which it is pushed, p its unloaded place (the
/// stage's object_x_mm, object_y_mm), n the beam's normal into the finger at
/// the contact r, R the radius of the pulley that the finger touches:
///
///   u = (r - R n - p) . e,    F = -f_c n . e,
///
/// (20) of the paper. Both come from one estimate, so that their errors are
/// correlated.
struct ForcePoint {
  std::size_t row;  ///< of its table, from 0
  double displacement_mm, force_N;
  Eigen::Matrix2d covariance;  ///< of (u, F), the stage's error included
  double approach_mm;          ///< -p . e: how far the object has been moved in
  /// +1 while it is moved in, -1 while it is withdrawn.
  int direction = 1;
  /// Whether the slider has moved since the last reversal; before that its
  /// friction may have any value between both limits.
  bool slides = true;
};

/// What one finger senses of each row of a table.
struct SensedLoads {
  struct Load {
    std::size_t row;
    SensedContact contact;
    Eigen::Vector2d place_mm;  ///< p
  };
  std::vector<Load> loads;  ///< of rows with one contact
  std::size_t rows = 0;
};

/// Throws InputError for a row without object_x_mm, object_y_mm.
SensedLoads SenseLoads(const FrameTable& table, ContactSensor* sensor,
                       const Finger& finger);

/// Direction of an object's line: the way of its centre against the stage,
/// where the scatter off it is least, pointing away from the finger.
struct SliderDirection {
  double angle_rad;
  double std_rad;  ///< NaN if it was given.
};
SliderDirection EstimateDirection(const SensedLoads& loads, double radius_mm);

/// Points of one trial along a direction. `stage_std_mm` is that of the place.
std::vector<ForcePoint> ForcePoints(const SensedLoads& loads,
                                    double direction_rad, double radius_mm,
                                    double stage_std_mm);

/// Of an object squeezed between two fingers: rows that both have, u the sum of
/// both (the object's compression), F their mean, which is how balance has
/// them. The directions are those of either finger's own frame S.
std::vector<ForcePoint> SqueezePoints(const std::vector<ForcePoint>& first,
                                      const std::vector<ForcePoint>& second);

/// Sets direction and slides, from the approach, row by row.
void MarkDirections(double stage_std_mm, std::vector<ForcePoint>* points);

}  // namespace finray

#endif  // FINRAY_PERCEPTION_FORCE_DISPLACEMENT_H_
