#ifndef FINRAY_CONTROL_RUN_EXPERIMENT_H_
#define FINRAY_CONTROL_RUN_EXPERIMENT_H_

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "finray/control/control_statistics.h"

namespace finray {

/// What one controller made of an experiment.
struct ControllerResult {
  ControllerSettings controller;
  LoopRun first;                 ///< the run of the first draw
  ControlStatistics statistics;  ///< over all draws
  std::string failure;           ///< of the first run that ended early
  std::optional<double> lag_s;   ///< of the first, behind a harmonic set-point
};

/// Runs all controllers over all draws; draw d has the seed seed + d, so that
/// results do not depend on threads. `progress`, if given, hears of the periods
/// of every run that is done, one call at a time.
std::vector<ControllerResult> RunExperiment(
    const Finger& finger, const Experiment& experiment,
    const Discretization& discretization, std::uint64_t seed, int threads,
    const std::function<void(std::size_t)>& progress = {});

}  // namespace finray

#endif  // FINRAY_CONTROL_RUN_EXPERIMENT_H_
