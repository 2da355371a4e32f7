#include "finray/control/gauge_zero.h"

#include "finray/io/error.h"
#include "finray/scene/clean_readings.h"

namespace finray {

GaugeZero::GaugeZero(const Finger& finger,
                     const Discretization& discretization) {
  EquilibriumSolver solver(finger, discretization);
  if (!solver.Solve({})) {
    throw InputError("the free finger has no equilibrium: " + solver.Why());
  }
  free_V_ = CleanReadings(solver).gauges_V;
  sum_V_.assign(free_V_.size(), 0);
}

void GaugeZero::Add(const Measurements& readings) {
  for (std::size_t j = 0; j < sum_V_.size(); ++j) {
    sum_V_[j] += readings.gauges_V[j] - free_V_[j];
  }
  ++count_;
}

void GaugeZero::Apply(Measurements* readings) const {
  if (count_ == 0) return;
  for (std::size_t j = 0; j < sum_V_.size(); ++j) {
    readings->gauges_V[j] -= sum_V_[j] / count_;
  }
}

}  // namespace finray
