#include "finray/estimation/frame_estimate.h"

#include <algorithm>
#include <cmath>

#include "finray/estimation/chi_squared.h"
#include "finray/finger/point_contact.h"

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

double FrameEstimate::p_value() const {
  return ChiSquaredTail(explained_chi2(), dof);
}

bool FrameEstimate::IsUnexplained() const {
  return ChiSquaredTail(explained_chi2(), std::max(1, dof)) < kUnexplained;
}

double FrameEstimate::noise_scale() const {
  return p_value() < kUnexplained ? std::sqrt(explained_chi2() / dof) : 1;
}

void FrameEstimate::SetNoise() {
  const double scale = noise_scale();
  for (int c = 0; c < contacts; ++c) {
    contact[c].arc_noise_mm = contact[c].arc_std_mm / scale;
    contact[c].normal_noise_N = contact[c].normal_std_N / scale;
  }
}

void FrameEstimate::SetIntervals(double length_mm) {
  for (int c = 0; c < contacts; ++c) {
    ContactEstimate& of = contact[c];
    double arc_below = 2 * of.arc_std_mm, arc_above = arc_below;
    double normal_below = 2 * of.normal_std_N, normal_above = normal_below;
    if (c == 0 && valley) {
      const bool known = calibration_covariance.size() == 0;
      const double arc_more =
          known ? 0 : 2 * std::sqrt(calibration_covariance(0, 0));
      const double normal_more =
          known ? 0 : 2 * std::sqrt(calibration_covariance(1, 1));
      arc_below = std::hypot(of.arc_mm - valley->arc_low_mm, arc_more);
      arc_above = std::hypot(valley->arc_high_mm - of.arc_mm, arc_more);
      normal_below =
          std::hypot(of.normal_N - valley->normal_low_N, normal_more);
      normal_above =
          std::hypot(valley->normal_high_N - of.normal_N, normal_more);
    }
    of.arc_low_mm = std::max(0.0, of.arc_mm - arc_below);
    of.arc_high_mm = std::min(length_mm, of.arc_mm + arc_above);
    of.normal_low_N = std::max(0.0, of.normal_N - normal_below);
    of.normal_high_N = of.normal_N + normal_above;
  }
}

namespace {

double FrictionOf(const FrameEstimate& estimate, double coefficient) {
  return std::isnan(estimate.friction) ? coefficient : estimate.friction;
}

}  // namespace

double EstimatedForce(const FrameEstimate& estimate,
                      double friction_coefficient) {
  const double friction = FrictionOf(estimate, friction_coefficient);
  // The magnitude of a single force does not depend on its direction.
  if (estimate.contacts < 2) {
    return std::hypot(1, friction) * estimate.contact[0].normal_N;
  }
  Eigen::Vector2d force(0, 0);
  for (int c = 0; c < estimate.contacts; ++c) {
    const ContactEstimate& contact = estimate.contact[c];
    force +=
        ContactForce({contact.arc_mm, contact.normal_N, friction, Side::kFront},
                     contact.pose.z());
  }
  return force.norm();
}

double EstimatedForceStd(const FrameEstimate& estimate,
                         double friction_coefficient) {
  const double friction = FrictionOf(estimate, friction_coefficient);
  if (!std::isnan(estimate.force_std_N)) return estimate.force_std_N;
  double std_N = 0;
  for (int c = 0; c < estimate.contacts; ++c) {
    std_N += std::hypot(1, friction) * estimate.contact[c].normal_std_N;
  }
  return std_N;
}

}  // namespace finray
