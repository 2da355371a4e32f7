#ifndef FINRAY_FINGER_POINT_CONTACT_H_
#define FINRAY_FINGER_POINT_CONTACT_H_

#include <Eigen/Core>
#include <cmath>

#include "finray/finger/finger.h"

namespace finray {

/// A point force on a beam: normal_N along the local normal into the finger,
/// and friction * normal_N along the tangent, towards the tip. The normal is
/// (sin(theta), -cos(theta)) on the front beam and its opposite on the back
/// beam.
struct PointContact {
  double arc_mm = 0;    ///< l_c, from the base of its beam.
  double normal_N = 0;  ///< f_c.
  double friction = 0;  ///< mu; the paper has none.
  Side side = Side::kFront;
  /// A point of the beam itself that nothing touches, such as a pin; the others
  /// lie on the beam's surface.
  bool is_mark = false;
};

/// The force of a contact on the finger in frame S, f (n + mu t), at a point
/// whose tangent angle is theta.
inline Eigen::Vector2d ContactForce(const PointContact& contact,
                                    double theta_rad) {
  const Eigen::Vector2d t(std::cos(theta_rad), std::sin(theta_rad));
  const double into = contact.side == Side::kFront ? 1 : -1;
  return contact.normal_N *
         (into * Eigen::Vector2d(t.y(), -t.x()) + contact.friction * t);
}

}  // namespace finray

#endif  // FINRAY_FINGER_POINT_CONTACT_H_
