#ifndef FINRAY_TESTS_ESTIMATION_GAUGE_VOLTS_H_
#define FINRAY_TESTS_ESTIMATION_GAUGE_VOLTS_H_

#include <cmath>
#include <vector>

#include "finray/statics/equilibrium.h"

namespace finray {

/// Returns the noise-free volts that the gauges of a solved finger read.
inline std::vector<double> Volts(const EquilibriumSolver& solver) {
  std::vector<double> volts;
  for (int j = 0; j < solver.model().gauges(); ++j) {
    const Gauge& gauge = solver.model().finger().gauges[j];
    volts.push_back(gauge.Volts(solver.gauge_angle(j)));
  }
  return volts;
}

/// 1 / std of the angles.
inline Eigen::VectorXd Weights(const Finger& finger) {
  Eigen::VectorXd weights(finger.gauges.size());
  for (Eigen::Index j = 0; j < weights.size(); ++j) {
    weights[j] = finger.gauges[j].AngleWeight();
  }
  return weights;
}

}  // namespace finray

#endif  // FINRAY_TESTS_ESTIMATION_GAUGE_VOLTS_H_
