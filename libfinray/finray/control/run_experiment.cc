#include "finray/control/run_experiment.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <mutex>

namespace finray {

void ErrorSums::Add(double error) {
  ++count;
  sum += error;
  squares += error * error;
  most = std::max(most, std::abs(error));
}

void ErrorSums::Add(const ErrorSums& other) {
  count += other.count;
  sum += other.sum;
  squares += other.squares;
  most = std::max(most, other.most);
}

double ErrorSums::rms() const {
  return std::sqrt(squares / static_cast<double>(count));
}

void ControlStatistics::Add(const ControlStatistics& other) {
  runs += other.runs;
  failed_runs += other.failed_runs;
  stopped_runs += other.stopped_runs;
  periods += other.periods;
  controlled += other.controlled;
  control.Add(other.control);
  settled.Add(other.settled);
  estimate.Add(other.estimate);
  worst_rms_N = std::max(worst_rms_N, other.worst_rms_N);
  best_rms_N = std::min(best_rms_N, other.best_rms_N);
}

ControlStatistics StatisticsOf(const LoopRun& run, const Experiment& experiment,
                               bool controlled) {
  ControlStatistics statistics;
  statistics.runs = 1;
  statistics.failed_runs = run.failure.empty() ? 0 : 1;
  if (!run.rows.empty() && run.rows.back().mode == LoopMode::kStopped) {
    statistics.stopped_runs = 1;
  }
  for (const LoopRow& row : run.rows) {
    if (row.time_s < experiment.measure_from_s) continue;
    ++statistics.periods;
    if (row.sure) {
      statistics.estimate.Add(row.seen.force_N - row.force_N);
    }
    if (!controlled) continue;
    if (row.mode == LoopMode::kControl) ++statistics.controlled;
    const double error = row.force_N - row.set_point_N;
    statistics.control.Add(error);
    if (experiment.set_point.SinceStep(row.time_s) >=
        experiment.settled_after_s) {
      statistics.settled.Add(error);
    }
  }
  if (statistics.control.count > 0) {
    statistics.worst_rms_N = statistics.best_rms_N = statistics.control.rms();
  }
  return statistics;
}

double LagSeconds(const LoopRun& run, const Experiment& experiment) {
  double lag = 0, least = std::numeric_limits<double>::infinity();
  for (int ms = -200; ms <= 600; ++ms) {
    double squares = 0;
    for (const LoopRow& row : run.rows) {
      if (row.time_s < experiment.measure_from_s) continue;
      const double error =
          row.force_N - experiment.set_point.At(row.time_s - 1e-3 * ms);
      squares += error * error;
    }
    if (squares < least) {
      least = squares;
      lag = 1e-3 * ms;
    }
  }
  return lag;
}

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
        experiment.set_point.amplitude != 0 &&
        !experiment.set_point.triangular) {
      result.lag_s = LagSeconds(result.first, experiment);
    }
  }
  return results;
}

}  // namespace finray
