#include "finray/control/run_experiment.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <mutex>

namespace finray {

std::vector<ControllerResult> RunExperiment(
    const Finger& finger, const Experiment& experiment,
    const Discretization& discretization, std::uint64_t seed, int threads,
    const std::function<void(std::size_t)>& progress) {
  const std::size_t draws = static_cast<std::size_t>(experiment.draws);
  std::vector<ControllerResult> results(experiment.controllers.size());
  std::vector<ControlStatistics> each(draws * results.size());
  std::vector<std::string> failures(each.size());
  std::mutex progress_mutex;
  tbb::task_arena(std::max(1, threads)).execute([&] {
    tbb::parallel_for(std::size_t{0}, each.size(), [&](std::size_t i) {
      const std::size_t c = i / draws, draw = i % draws;
      const ControllerSettings& controller = experiment.controllers[c];
      LoopRun run =
          RunLoop(finger, experiment, controller, discretization, seed + draw);
      each[i] = StatisticsOf(run, experiment,
                             controller.kind != ControllerKind::kNone);
      failures[i] = run.failure;
      if (progress) {
        const std::lock_guard<std::mutex> lock(progress_mutex);
        progress(run.rows.size());
      }
      if (draw == 0) results[c].first = std::move(run);
    });
  });
  for (std::size_t c = 0; c < results.size(); ++c) {
    ControllerResult& result = results[c];
    result.controller = experiment.controllers[c];
    for (std::size_t d = 0; d < draws; ++d) {
      result.statistics.Add(each[c * draws + d]);
      if (result.failure.empty()) result.failure = failures[c * draws + d];
    }
    if (result.controller.kind != ControllerKind::kNone &&
        std::holds_alternative<HarmonicTrajectory>(
            experiment.set_point.shape())) {
      result.lag_s = LagSeconds(result.first, experiment);
    }
  }
  return results;
}

}  // namespace finray
