#include "finray/calib/contact_guess.h"

#include <algorithm>
#include <cmath>

#include "finray/finger/geometry.h"

namespace finray {

ContactGuess::ContactGuess(const Finger& finger, const Plan& plan,
                           const Discretization& discretization,
                           const MeasurementBlocks* blocks,
                           CalibrationParameters* parameters)
    : blocks_(*blocks),
      parameters_(*parameters),
      length_mm_(finger.front_length_mm),
      force_unit_N_(ForceUnit(finger)),
      solver_(finger, discretization),
      table_(&solver_, plan.scene.friction_coefficient,
             plan.scene.circle_radius_mm()),
      fit_(finger, discretization, plan.scene.circle_radius_mm()),
      circle_(plan.scene.circle_radius_mm().has_value()) {
  const auto size =
      static_cast<Eigen::Index>(finger.gauges.size() + (circle_ ? 2 : 0));
  values_.resize(size);
  weights_.resize(size);
  fit_.set_most_force(table_.heaviest_N());
}

ContactGuess::Place ContactGuess::Of(const CalibrationFrame& frame) {
  Place place{length_mm_ / 2, force_unit_N_, {}};
  std::optional<Place> found;
  if (circle_ && frame.object_mm.allFinite()) {
    const Eigen::Map<const Eigen::Vector2d> origin(
        parameters_.object_origin_mm(frame.log));
    found = FromCircle(frame.object_mm + origin);
  } else {
    found = FromGauges(frame);
  }
  if (found) place = *found;
  if (std::isfinite(frame.contact_mm)) {
    place.arc_mm = std::clamp(frame.contact_mm, 0.0, length_mm_);
  }
  const double force =
      frame.force_xy_N.allFinite() ? frame.force_xy_N.norm() : frame.force_N;
  if (std::isfinite(force)) place.normal_N = std::max(force, 0.0);
  return place;
}

bool ContactGuess::FindStart() {
  table_.FindStarts(values_, weights_, &starts_);
  return !starts_.empty();
}

// The contact at which the circle touches, its centre being there. It is met
// exactly: what all stiffnesses and forces have in common may not be in the
// data, and stays as given only from a start near a solution.
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
    const CalibrationFrame& frame) {
  values_.setZero();
  weights_.setZero();
  for (int j = 0; j < static_cast<int>(frame.gauges_V.size()); ++j) {
    const double gain = parameters_.gains_V_per_rad[j];
    if (!std::isfinite(frame.gauges_V[j]) || gain == 0) continue;
    values_[j] =
        (frame.gauges_V[j] - parameters_.readings.Sum(frame, j)) / gain;
    weights_[j] = std::abs(gain) / blocks_.gauge_std_V(j);
  }
  if (!FindStart()) return std::nullopt;
  return Place{starts_[0].contacts[0].arc_mm, starts_[0].contacts[0].normal_N,
               *starts_[0].state};
}

}  // namespace finray
