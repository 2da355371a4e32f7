#ifndef FINRAY_OBJECTS_CIRCLE_CENTRE_H_
#define FINRAY_OBJECTS_CIRCLE_CENTRE_H_

#include <Eigen/Core>
#include <cmath>

namespace finray {

/// The centre of a circle of radius R that touches the front beam from outside
/// at a point x, y where the tangent angle is theta,
///
///   c = (x, y) - R (sin(theta), -cos(theta)),
///
/// in mm and rad.
inline Eigen::Vector2d CircleCentre(const Eigen::Vector3d& contact_pose,
                                    double radius_mm) {
  const double theta = contact_pose[2];
  return contact_pose.head<2>() -
         radius_mm * Eigen::Vector2d(std::sin(theta), -std::cos(theta));
}

/// The derivative of CircleCentre by theta.
inline Eigen::Vector2d CircleCentreByAngle(double theta, double radius_mm) {
  return -radius_mm * Eigen::Vector2d(std::cos(theta), std::sin(theta));
}

}  // namespace finray

#endif  // FINRAY_OBJECTS_CIRCLE_CENTRE_H_
