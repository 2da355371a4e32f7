#include "finray/calib/contact_guess.h"

#include <vector>

namespace finray {

ContactGuess::ContactGuess(const Finger& finger, const Scene& scene,
                           const Discretization& discretization)
    : solver_(finger, discretization),
      table_(&solver_, scene.friction_coefficient, scene.circle_radius_mm()),
      fit_(finger, discretization, scene.circle_radius_mm()) {
  const auto size = static_cast<Eigen::Index>(
      finger.gauges.size() + (scene.circle_radius_mm() ? 2 : 0));
  values_.resize(size);
  weights_.resize(size);
  fit_.set_most_force(table_.heaviest_N());
}

bool ContactGuess::FindStart() {
  table_.FindStarts(values_, weights_, &starts_);
  return !starts_.empty();
}

std::optional<ContactGuess::Place> ContactGuess::FromCircle(
    const Eigen::Vector2d& centre_mm) {
  values_.setZero();
  weights_.setZero();
  values_.tail<2>() = centre_mm;
  weights_.tail<2>().setOnes();
  if (!FindStart()) return std::nullopt;
  const ContactStart& start = starts_[0];
  std::vector<PointContact> contact = {start.contacts[0]};
  fit_.set_state(*start.state);
  if (!fit_.Fit(values_, weights_, &contact)) {
    return Place{start.contacts[0].arc_mm, start.contacts[0].normal_N,
                 *start.state};
  }
  Place place{contact[0].arc_mm, contact[0].normal_N, {}};
  fit_.SaveState(&place.state);
  return place;
}

std::optional<ContactGuess::Place> ContactGuess::FromGauges(
    const Eigen::VectorXd& angles_rad, const Eigen::VectorXd& weights) {
  values_.setZero();
  weights_.setZero();
  values_.head(angles_rad.size()) = angles_rad;
  weights_.head(weights.size()) = weights;
  if (!FindStart()) return std::nullopt;
  return Place{starts_[0].contacts[0].arc_mm, starts_[0].contacts[0].normal_N,
               *starts_[0].state};
}

}  // namespace finray
