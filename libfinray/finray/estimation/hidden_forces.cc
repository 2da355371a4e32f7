#include "finray/estimation/hidden_forces.h"

#include <algorithm>
#include <cmath>

#include "finray/estimation/frame_estimator.h"
#include "finray/io/error.h"

namespace finray {
namespace {

constexpr int kHiddenPlaces = 56;
// Forces are tried in steps of this factor, from this share of the largest one.
constexpr double kStep = 1.25, kFirstForceShare = 1e-5;

Eigen::VectorXd VoltsOf(const EquilibriumSolver& solver) {
  const std::vector<Gauge>& gauges = solver.model().finger().gauges;
  Eigen::VectorXd volts(static_cast<Eigen::Index>(gauges.size()));
  for (int j = 0; j < static_cast<int>(gauges.size()); ++j) {
    // Anywhere in its loop a gauge with hysteresis is off by half / sqrt(3).
    const double std_V =
        std::hypot(gauges[j].noise_V, gauges[j].HysteresisV() / std::sqrt(3.0));
    volts[j] = gauges[j].Volts(solver.gauge_angle(j)) / std_V;
  }
  return volts;
}

}  // namespace

HiddenForces FindHiddenForces(const Finger& finger, const Scene& scene,
                              const Discretization& discretization) {
  EquilibriumSolver solver(finger, discretization);
  if (!solver.Solve({})) {
    throw InputError("finger '" + finger.name + "' has no unloaded shape");
  }
  const Eigen::VectorXd free = VoltsOf(solver);
  const double most_N =
      scene.force_max_N.value_or(GaugeTable::HeaviestForce_N(finger));
  const double noticed = std::sqrt(FrameEstimator::kSignificance) + kNoticed;
  HiddenForces hidden;
  for (int i = 0; i <= kHiddenPlaces; ++i) {
    const double arc_mm = finger.front_length_mm * i / kHiddenPlaces;
    double below_N = 0, below = 0, hidden_N = most_N;
    solver.Reset();
    for (double force_N = kFirstForceShare * most_N;;
         force_N = std::min(kStep * force_N, most_N)) {
      // Where the finger has no equilibrium, it cannot be overlooked.
      const bool stands =
          solver.Solve({{arc_mm, force_N, scene.friction_coefficient}});
      const double distance =
          stands ? (VoltsOf(solver) - free).norm() : 2 * noticed;
      if (distance >= noticed) {
        hidden_N = below_N +
                   (force_N - below_N) * (noticed - below) / (distance - below);
        break;
      }
      if (force_N == most_N) break;
      below_N = force_N;
      below = distance;
    }
    hidden.contact_mm.push_back(arc_mm);
    hidden.normal_N.push_back(hidden_N);
  }
  return hidden;
}

}  // namespace finray
