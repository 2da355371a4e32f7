#ifndef FINRAY_PERCEPTION_TOUCH_H_
#define FINRAY_PERCEPTION_TOUCH_H_

#include <Eigen/Core>
#include <cstddef>
#include <map>
#include <vector>

#include "finray/io/frame_table.h"
#include "finray/perception/contact_sensor.h"

namespace finray {

/// What one contact tells about an object, in the object's own frame (mm, rad):
///
///   point = R(-a) (r - p),   normal angle = theta - pi/2 - a.
///
/// r and theta are those of the front beam at the contact; p and a are position
/// and angle of the object in frame S. The outline passes through the point,
/// its outward normal there has that angle and points into the finger, and the
/// whole outline lies on one side of the beam.
struct Touch {
  std::size_t row;  ///< of the table, from 0
  Eigen::Vector2d point_mm;
  double normal_angle_rad;
  double normal_N;
  Eigen::Matrix3d covariance;  ///< of (x, y, normal angle)
  /// The front beam from base to tip, and the arc length of the contact on it.
  std::vector<Eigen::Vector2d> beam_mm;
  double contact_arc_mm;
  double beam_length_mm;

  Eigen::Vector2d Normal() const;
  /// The part of the beam within `reach_mm` of the contact.
  std::vector<Eigen::Vector2d> BeamNear(double reach_mm) const;
};

/// All touches of a table, and how many of its rows had which status.
struct Touches {
  std::vector<Touch> usable;
  std::map<FrameStatus, std::size_t> rows;

  std::size_t all_rows() const;
};

/// Senses every row of a table. A row needs object_x_mm and object_y_mm
/// (object_angle_deg defaults to 0), and its gauges. A table without gauge
/// columns needs contact_<c>_mm and normal_<c>_N with their std instead. Throws
/// InputError at the line of a row that lacks the object's place or a std.
Touches SenseTouches(const FrameTable& table, const Finger& finger,
                     const Scene& scene, const Discretization& discretization);

}  // namespace finray

#endif  // FINRAY_PERCEPTION_TOUCH_H_
