#ifndef FINRAY_TESTS_STUDIES_PLANNED_LOG_H_
#define FINRAY_TESTS_STUDIES_PLANNED_LOG_H_

#include <random>

#include "finray/calib/problem/calibration_log.h"
#include "finray/calib/solve/robust_solve.h"

namespace finray {

/// Adds to exact readings the noise that finger and plan declare.
inline CalibrationLogs WithNoise(CalibrationLogs logs, const Finger& finger,
                                 const Plan& plan, std::mt19937_64* generator) {
  std::normal_distribution<double> normal;
  for (CalibrationFrame& frame : logs.frames) {
    for (std::size_t j = 0; j < finger.gauges.size(); ++j) {
      frame.gauges_V[j] += plan.gauge_std_V.value_or(finger.gauges[j].noise_V) *
                           normal(*generator);
    }
    if (!frame.contact) continue;
    frame.force_N += plan.force_std_N * normal(*generator);
    for (double& place : frame.object_mm) {
      place += plan.object_std_mm * normal(*generator);
    }
  }
  return logs;
}

/// Calibrates `drawn` from the logs. Without a solution it throws.
inline Finger CalibratedFrom(const Finger& drawn, const Plan& plan,
                             const CalibrationLogs& logs) {
  CalibrationProblem problem(drawn, plan, logs, {}, 2);
  const CalibrationSolution solution = SolveOnce(&problem);
  if (!solution.solve.converged) throw std::runtime_error("not converged");
  return problem.parameters().Apply(drawn);
}

}  // namespace finray

#endif  // FINRAY_TESTS_STUDIES_PLANNED_LOG_H_
