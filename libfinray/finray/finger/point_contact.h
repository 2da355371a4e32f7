#ifndef FINRAY_FINGER_POINT_CONTACT_H_
#define FINRAY_FINGER_POINT_CONTACT_H_

#include <Eigen/Core>
#include <cmath>

#include "finray/finger/finger.h"

namespace finray {

/// A point force on a beam: normal_N along the local normal into the finger,
/// (sin(theta), -cos(theta)) on the front beam and its opposite on the back
/// one, plus friction * normal_N along the tangent, towards the tip.
struct PointContact {
  double arc_mm = 0;
  double normal_N = 0;
  double friction = 0;
  Side side = Side::kFront;
};

/// The force of a contact on the finger in frame S, f (n + mu t), where the
/// tangent of its beam has the angle theta.
inline Eigen::Vector2d ContactForce(const PointContact& contact,
                                    double theta_rad) {
  const Eigen::Vector2d t(std::cos(theta_rad), std::sin(theta_rad));
  const double into = contact.side == Side::kFront ? 1 : -1;
  return contact.normal_N *
         (into * Eigen::Vector2d(t.y(), -t.x()) + contact.friction * t);
}

}  // namespace finray

#endif  // FINRAY_FINGER_POINT_CONTACT_H_
