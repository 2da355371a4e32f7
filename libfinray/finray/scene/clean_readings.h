#ifndef FINRAY_SCENE_CLEAN_READINGS_H_
#define FINRAY_SCENE_CLEAN_READINGS_H_

#include "finray/scene/measurements.h"
#include "finray/statics/equilibrium.h"

namespace finray {

/// Returns the volts that the gauges of the solver's finger read at its present
/// equilibrium, without noise.
inline Measurements CleanReadings(const EquilibriumSolver& solver) {
  Measurements readings;
  const std::vector<Gauge>& gauges = solver.model().finger().gauges;
  for (int j = 0; j < static_cast<int>(gauges.size()); ++j) {
    readings.gauges_V.push_back(gauges[j].Volts(solver.gauge_angle(j)));
  }
  return readings;
}

}  // namespace finray

#endif  // FINRAY_SCENE_CLEAN_READINGS_H_
