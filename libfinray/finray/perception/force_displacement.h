#ifndef FINRAY_PERCEPTION_FORCE_DISPLACEMENT_H_
#define FINRAY_PERCEPTION_FORCE_DISPLACEMENT_H_

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "finray/io/frame_table.h"
#include "finray/perception/contact_sensor.h"

namespace finray {

/// Force and displacement of an object that yields along a line, sensed by the
/// finger that presses it, (20) of the paper:
///
///   u = (r - R n - p) . e,    F = -f_c n . e      (mm, N).
///
/// e is the direction in which the object is pushed, p its unloaded place (the
/// stage's object_x_mm, object_y_mm), n the beam's normal into the finger at
/// the contact r, and R the radius of the pulley that the finger touches. The
/// errors of u and F are correlated, as both come from one estimate.
struct ForcePoint {
  std::size_t row;  ///< of its table, from 0
  double displacement_mm, force_N;
  Eigen::Matrix2d covariance;  ///< of (u, F), with the error of the stage
  double approach_mm;          ///< -p . e, how far the object has been moved in
  /// +1 while the object is moved in, -1 while it is withdrawn.
  int direction = 1;
  /// False from a reversal until the slider moves again. Until then its
  /// friction may have any value between both limits.
  bool slides = true;
};

/// What one finger senses of a table.
struct SensedLoads {
  struct Load {
    std::size_t row;
    SensedContact contact;
    Eigen::Vector2d place_mm;  ///< p
  };
  std::vector<Load> loads;  ///< of the rows with one contact
  std::size_t rows = 0;     ///< all rows
};

/// Throws InputError for a row without object_x_mm, object_y_mm.
SensedLoads SenseLoads(const FrameTable& table, ContactSensor* sensor,
                       const Finger& finger);

/// The direction in which an object is pushed, from +x of frame S.
struct SliderDirection {
  double angle_rad;
  double std_rad;  ///< NaN for a given direction
};
/// Estimates it as the line about which the path of the object's centre against
/// the stage scatters least. Throws InputError for fewer than three loads.
SliderDirection EstimateDirection(const SensedLoads& loads, double radius_mm);

/// The points of one trial. `stage_std_mm` is the std of the place.
std::vector<ForcePoint> ForcePoints(const SensedLoads& loads,
                                    double direction_rad, double radius_mm,
                                    double stage_std_mm);

/// The points of an object squeezed between two fingers, for the rows that both
/// have: u is the sum of both displacements, F the mean of both forces. Each
/// finger's points use the direction in its own frame S.
std::vector<ForcePoint> SqueezePoints(const std::vector<ForcePoint>& first,
                                      const std::vector<ForcePoint>& second);

/// Sets `direction` and `slides` of each point from the approaches.
void MarkDirections(double stage_std_mm, std::vector<ForcePoint>* points);

}  // namespace finray

#endif  // FINRAY_PERCEPTION_FORCE_DISPLACEMENT_H_
