#include "finray/calib/problem/offset_guess.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "finray/calib/problem/calibration_problem.h"
#include "finray/statics/equilibrium.h"

namespace finray {
namespace {

struct Mean {
  double sum = 0;
  int count = 0;
};

// Calls `visit(frame, gauge)` for each reading of the finger without contact.
template <class Visit>
void VisitFreeReadings(const CalibrationLogs& logs, const Visit& visit) {
  for (const CalibrationFrame& frame : logs.frames) {
    if (frame.contact || frame.IsBench()) continue;
    for (int j = 0; j < static_cast<int>(frame.gauges_V.size()); ++j) {
      if (std::isfinite(frame.gauges_V[j])) visit(frame, j);
    }
  }
}

}  // namespace

void GuessOffsets(const CalibrationLogs& logs,
                  CalibrationParameters* parameters) {
  std::unordered_map<double*, Mean> means;
  VisitFreeReadings(logs, [&](const CalibrationFrame& frame, int j) {
    if (frame.held_out) return;
    Mean& mean = means[parameters->readings.offset_V(j, frame.log)];
    mean.sum += frame.gauges_V[j];
    ++mean.count;
  });
  for (const auto& [offset, mean] : means) *offset = mean.sum / mean.count;
}

void ZeroHeldOutLogs(CalibrationProblem* problem) {
  CalibrationParameters& parameters = problem->parameters();
  const std::vector<bool> held_out = problem->logs().HeldOut();
  const int last = parameters.last_fitted_log();
  for (int log = 0; last >= 0 && log < static_cast<int>(held_out.size());
       ++log) {
    if (!held_out[log]) continue;
    // A log without a free frame keeps these values.
    for (int j = 0; j < static_cast<int>(problem->finger().gauges.size());
         ++j) {
      *parameters.readings.offset_V(j, log) =
          *parameters.readings.offset_V(j, last);
    }
    std::copy_n(parameters.object_origin_mm(last), 2,
                parameters.object_origin_mm(log));
  }
  if (!problem->plan().family(ParameterFamily::kGaugeOffset).per_log) return;
  // Ribs of other than nominal length bend the finger without load.
  EquilibriumSolver free(parameters.Apply(problem->finger()),
                         problem->discretization());
  if (!free.Solve({})) return;
  std::unordered_map<double*, Mean> errors;
  VisitFreeReadings(problem->logs(), [&](const CalibrationFrame& frame, int j) {
    if (!held_out[frame.log]) return;
    Mean& error = errors[parameters.readings.offset_V(j, frame.log)];
    error.sum += frame.gauges_V[j] -
                 parameters.gains_V_per_rad[j] * free.gauge_angle(j) -
                 parameters.readings.Sum(frame, j);
    ++error.count;
  });
  for (const auto& [offset, error] : errors) {
    *offset += error.sum / error.count;
  }
}

}  // namespace finray
