#ifndef FINRAY_PERCEPTION_TOUCH_H_
#define FINRAY_PERCEPTION_TOUCH_H_

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "finray/io/frame_table.h"
#include "finray/objects/outline.h"
#include "finray/perception/contact_sensor.h"

namespace finray {

/// What one contact tells of an object, in the object's own frame:
///
///   point = R(-a) (r - p),   normal angle = theta - pi/2 - a,
///
/// with r and theta of the front beam at the contact, p and a of the object's
/// frame in frame S. The outline passes through the point, its outward normal
/// there is the beam's normal into the finger, and all of it is on its own side
/// of the beam.
struct Touch {
  std::size_t row;  ///< of the table, from 0
  Eigen::Vector2d point_mm;
  double normal_angle_rad;
  double normal_N;
  Eigen::Matrix3d covariance;  ///< of (x, y, normal angle)
  /// The front beam, base to tip, and where in it the contact lies.
  std::vector<Eigen::Vector2d> beam_mm;
  double contact_arc_mm;
  double beam_length_mm;

  Eigen::Vector2d Normal() const;
  /// The part of the beam within `reach_mm` of the contact.
  std::vector<Eigen::Vector2d> BeamNear(double reach_mm) const;
};

/// All touches of a table, and what became of its rows.
struct Touches {
  std::vector<Touch> usable;
  std::map<FrameStatus, std::size_t> rows;  ///< by status

  std::size_t all_rows() const;
};

/// Senses every row. Each needs object_x_mm and object_y_mm (object_angle_deg
/// defaults to 0) and gauges, or, in a table that has no gauge columns,
/// contact_<c>_mm and normal_<c>_N with their std. Throws InputError naming the
/// line of a row without a place of the object.
Touches SenseTouches(const FrameTable& table, const Finger& finger,
                     const Scene& scene, const Discretization& discretization);

}  // namespace finray

#endif  // FINRAY_PERCEPTION_TOUCH_H_
