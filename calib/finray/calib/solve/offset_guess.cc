// What gauges read in free frames.

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "finray/calib/problem/calibration_problem.h"

namespace finray {
namespace {

struct Mean {
  double sum = 0;
  int count = 0;

  void Add(double value) {
    sum += value;
    ++count;
  }
};

}  // namespace

// To begin with, offsets are what the gauges read in free frames.
void CalibrationProblem::GuessOffsets() {
  if (!plan_.family(ParameterFamily::kGaugeOffset).free) return;
  std::unordered_map<double*, Mean> means;
  for (const CalibrationFrame& frame : logs().frames) {
    if (frame.contact || frame.IsBench() || frame.held_out) continue;
    for (int j = 0; j < static_cast<int>(frame.gauges_V.size()); ++j) {
      if (!std::isfinite(frame.gauges_V[j])) continue;
      means[parameters_.readings.offset_V(j, frame.log)].Add(frame.gauges_V[j]);
    }
  }
  for (const auto& [offset, mean] : means) *offset = mean.sum / mean.count;
}

void CalibrationProblem::ZeroHeldOutLogs() {
  const std::vector<bool> held_out = logs().HeldOut();
  const int last = parameters_.last_fitted_log();
  for (int log = 0; last >= 0 && log < static_cast<int>(held_out.size());
       ++log) {
    if (!held_out[log]) continue;
    // Without a free frame nothing better is known.
    for (int j = 0; j < static_cast<int>(finger_.gauges.size()); ++j) {
      *parameters_.readings.offset_V(j, log) =
          *parameters_.readings.offset_V(j, last);
    }
    std::copy_n(parameters_.object_origin_mm(last), 2,
                parameters_.object_origin_mm(log));
  }
  if (!plan_.family(ParameterFamily::kGaugeOffset).per_log) return;
  // Ribs that are not as drawn bend the finger without load.
  EquilibriumSolver free(parameters_.Apply(finger_), discretization_);
  if (!free.Solve({})) return;
  std::unordered_map<double*, Mean> errors;
  for (const CalibrationFrame& frame : logs().frames) {
    if (frame.contact || frame.IsBench() || !held_out[frame.log]) continue;
    for (int j = 0; j < static_cast<int>(frame.gauges_V.size()); ++j) {
      if (!std::isfinite(frame.gauges_V[j])) continue;
      errors[parameters_.readings.offset_V(j, frame.log)].Add(
          frame.gauges_V[j] -
          parameters_.gains_V_per_rad[j] * free.gauge_angle(j) -
          parameters_.readings.Sum(frame, j));
    }
  }
  for (const auto& [offset, error] : errors) {
    *offset += error.sum / error.count;
  }
}

}  // namespace finray
