#ifndef FINRAY_STATICS_CONTACT_FORCE_H_
#define FINRAY_STATICS_CONTACT_FORCE_H_

#include <Eigen/Core>
#include <cmath>

#include "finray/statics/ladder.h"

namespace finray {

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

#endif  // FINRAY_STATICS_CONTACT_FORCE_H_
