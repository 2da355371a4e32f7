#include "finray/sensing/frame_estimate.h"

#include <cmath>

#include "finray/finger/point_contact.h"
#include "finray/sensing/chi_squared.h"

namespace finray {

const char* StatusName(FrameStatus status) {
  switch (status) {
    case FrameStatus::kOk:
      return "ok";
    case FrameStatus::kNoContact:
      return "no_contact";
    case FrameStatus::kUnobservable:
      return "unobservable";
    case FrameStatus::kNotConverged:
      return "not_converged";
    case FrameStatus::kBadInput:
      return "bad_input";
  }
  return "";
}

double FrameEstimate::p_value() const { return ChiSquaredTail(chi2, dof); }

double FrameEstimate::noise_scale() const {
  return p_value() < kUnexplained ? std::sqrt(chi2 / dof) : 1;
}

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
