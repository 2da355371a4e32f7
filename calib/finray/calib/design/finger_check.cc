#include "finray/calib/design/finger_check.h"

#include <cmath>
#include <stdexcept>

#include "finray/finger/geometry.h"
#include "finray/statics/equilibrium.h"

namespace finray {
namespace {

std::vector<RibFigures> RibsAtRest(const Finger& finger,
                                   EquilibriumSolver* solver) {
  if (!solver->Solve({})) {
    throw std::runtime_error(
        "the finger has no equilibrium at rest, so its ribs do not fit "
        "(length_mm): " +
        solver->Why());
  }
  std::vector<RibFigures> ribs;
  for (std::size_t i = 0; i < finger.ribs.size(); ++i) {
    const Rib& rib = finger.ribs[i];
    const Eigen::Vector2d along =
        UndeformedPoint(finger, Side::kBack, rib.back_mm) -
        UndeformedPoint(finger, Side::kFront, rib.front_mm);
    ribs.push_back({rib.front_mm, rib.back_mm,
                    std::atan2(along.y(), along.x()) / kDegree, rib.length_mm,
                    along.norm(), solver->rib_tension(static_cast<int>(i))});
  }
  return ribs;
}

HeightFigures AtHeight(const Finger& finger, double contact_mm,
                       EquilibriumSolver* solver) {
  HeightFigures at{contact_mm, 0, {}};
  const double small_N = 1e-3 * ForceUnit(finger);
  solver->Reset();
  if (!solver->SolveWithSensitivities({{contact_mm, small_N}})) {
    throw std::runtime_error("the finger has no equilibrium under " +
                             std::to_string(small_N) + " N: " + solver->Why());
  }
  constexpr int kByForce = 1;
  const int gauges = static_cast<int>(finger.gauges.size());
  for (int j = 0; j < gauges; ++j) {
    at.angle_rad_per_N.push_back(solver->d_outputs()(j, kByForce));
  }
  at.stiffness_N_per_mm = 1 / solver->d_outputs()(gauges, kByForce);
  return at;
}

LimitLoad FindLimit(const Finger& finger, EquilibriumSolver* solver) {
  const double contact_mm = finger.front_length_mm / 2;
  const double most_N = kLargestCheckedLoad * ForceUnit(finger);
  solver->Reset();
  if (solver->Solve({{contact_mm, most_N}})) return {contact_mm, most_N, false};
  return {contact_mm, solver->path_fraction() * most_N,
          solver->status() == SolveStatus::kLimitPoint};
}

}  // namespace

FingerCheck CheckFinger(const Finger& finger,
                        const std::vector<WrittenPlate>& plates,
                        const Discretization& discretization) {
  EquilibriumSolver solver(finger, discretization);
  FingerCheck check;
  check.back_length_mm = BeamLength(finger, Side::kBack);
  check.back_base_mm = BeamBase(finger, Side::kBack).x();
  check.force_unit_N = ForceUnit(finger);
  check.ribs = RibsAtRest(finger, &solver);
  for (std::size_t i = 0; i < check.heights.size(); ++i) {
    check.heights[i] = AtHeight(
        finger, finger.front_length_mm * static_cast<double>(i + 1) / 4,
        &solver);
  }
  check.limit = FindLimit(finger, &solver);
  check.warnings = FingerWarnings(finger, plates, check);
  return check;
}

}  // namespace finray
