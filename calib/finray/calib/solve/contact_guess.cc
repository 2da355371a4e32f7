#include "finray/calib/solve/contact_guess.h"

#include <algorithm>
#include <cmath>

#include "finray/finger/geometry.h"

namespace finray {
namespace {

// Places are fitted from, and states gone on from: half as many rows as for
// estimates, and as exact as what follows needs. The fit is of l_0 and
// EI / l_0^2.
constexpr int kRows = GaugeTable::kMostRows / 2;
constexpr double kTableTolerance = 1e-6, kFitTolerance = 1e-3;

EquilibriumSolver SolverFor(const Finger& finger,
                            const Discretization& discretization) {
  EquilibriumSolver solver(finger, discretization);
  solver.set_tolerance(kTableTolerance);
  return solver;
}

}  // namespace

ContactGuess::ContactGuess(const Finger& finger, const Plan& plan,
                           const Discretization& discretization,
                           const CalibrationBlocks* blocks,
                           CalibrationParameters* parameters, int threads)
    : blocks_(*blocks),
      parameters_(*parameters),
      length_mm_(finger.front_length_mm),
      force_unit_N_(ForceUnit(finger)),
      object_std_mm_(plan.object_std_mm),
      solver_(SolverFor(finger, discretization)),
      table_(&solver_, plan.scene.friction_coefficient,
             plan.scene.circle_radius_mm(), threads, kRows),
      fit_(finger, discretization, plan.scene.circle_radius_mm()),
      circle_(plan.scene.circle_radius_mm().has_value()) {
  const auto size =
      static_cast<Eigen::Index>(finger.gauges.size() + (circle_ ? 2 : 0));
  values_.resize(size);
  weights_.resize(size);
  fit_.set_most_force(table_.heaviest_N());
  fit_.set_tolerance(kFitTolerance);
}

ContactGuess::Place ContactGuess::Of(const CalibrationFrame& frame, From from) {
  values_.setZero();
  weights_.setZero();
  const bool by_object = circle_ && frame.object_mm.allFinite();
  if (by_object) AddCircle(frame);
  if (!by_object || from == From::kAll) AddGauges(frame);
  // The circle is met exactly: what all stiffnesses and forces have in common
  // may not be in the data, and stays as given only from a start near a
  // solution. Gauges of unknown gains would be met at any price.
  Place place = FromTable(by_object || from == From::kAll);
  if (std::isfinite(frame.contact_mm)) {
    place.arc_mm = std::clamp(frame.contact_mm, 0.0, length_mm_);
  }
  const double force =
      frame.force_xy_N.allFinite() ? frame.force_xy_N.norm() : frame.force_N;
  // A wild one may be more than the finger can carry.
  if (from == From::kObjectFirst && force <= table_.heaviest_N()) {
    place.normal_N = std::max(force, 0.0);
  }
  return place;
}

void ContactGuess::AddCircle(const CalibrationFrame& frame) {
  const Eigen::Map<const Eigen::Vector2d> origin(
      parameters_.object_origin_mm(frame.log));
  values_.tail<2>() = frame.object_mm + origin;
  weights_.tail<2>().setConstant(1 / object_std_mm_);
}

void ContactGuess::AddGauges(const CalibrationFrame& frame) {
  for (int j = 0; j < static_cast<int>(frame.gauges_V.size()); ++j) {
    const double gain = parameters_.gains_V_per_rad[j];
    if (!std::isfinite(frame.gauges_V[j]) || gain == 0) continue;
    values_[j] =
        (frame.gauges_V[j] - parameters_.readings.Sum(frame, j)) / gain;
    weights_[j] = std::abs(gain) / blocks_.gauge_std_V(j);
  }
}

ContactGuess::Place ContactGuess::FromTable(bool fit) {
  const ContactStart start = table_.BestStart(values_, weights_);
  if (start.state == nullptr) {
    return {length_mm_ / 2, force_unit_N_, {}, false};
  }
  std::vector<PointContact> contact = {start.contacts[0]};
  Place place{contact[0].arc_mm, contact[0].normal_N, *start.state, false};
  if (!fit) return place;
  fit_.set_state(*start.state);
  if (!fit_.Fit(values_, weights_, &contact)) return place;
  place.arc_mm = contact[0].arc_mm;
  place.normal_N = contact[0].normal_N;
  fit_.SaveState(&place.state);
  place.met = true;
  return place;
}

}  // namespace finray
