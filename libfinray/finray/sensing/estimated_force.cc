#include "finray/sensing/estimated_force.h"

#include <cmath>

#include "finray/finger/point_contact.h"

namespace finray {

double EstimatedForce(const FrameEstimate& estimate,
                      double friction_coefficient) {
  // The magnitude of a single force does not depend on its direction.
  if (estimate.contacts < 2) {
    return std::hypot(1, friction_coefficient) * estimate.contact[0].normal_N;
  }
  Eigen::Vector2d force(0, 0);
  for (int c = 0; c < estimate.contacts; ++c) {
    const ContactEstimate& contact = estimate.contact[c];
    force += ContactForce(
        {contact.arc_mm, contact.normal_N, friction_coefficient, Side::kFront},
        contact.pose.z());
  }
  return force.norm();
}

}  // namespace finray
