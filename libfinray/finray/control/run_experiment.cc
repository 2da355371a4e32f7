#include "finray/control/run_experiment.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <mutex>

#include "finray/batch/result_rows.h"
#include "finray/control/experiment.h"
#include "finray/scene/frame_columns.h"

namespace finray {
namespace {

using YAML::Key;
using YAML::Value;

void EmitErrors(const char* name, const ErrorSums& errors, YamlEmitter* yaml) {
  if (errors.count == 0) return;
  *yaml << Key << name << Value;
  YamlLine(yaml, "periods", errors.count, "rms_N", errors.rms(), "max_N",
           errors.most, "mean_N", errors.mean());
}

void EmitController(const Experiment& experiment,
                    const ControllerResult& result, YamlEmitter* yaml) {
  const ControlStatistics& s = result.statistics;
  const auto percent = [&s](std::size_t count) {
    return 100.0 * static_cast<double>(count) / static_cast<double>(s.periods);
  };
  *yaml << YAML::BeginMap;
  YamlPairs(yaml, "name", result.controller.name, "preview",
            result.controller.preview);
  *yaml << Key << "logs" << Value << YAML::Flow
        << ControlLogNames(experiment, result.controller);
  YamlPairs(yaml, "runs", s.runs, "failed_runs", s.failed_runs, "stopped_runs",
            s.stopped_runs);
  if (!s.failure.empty()) YamlPair(yaml, "failure", s.failure);
  EmitErrors("control_error", s.control, yaml);
  if (s.settled.count != s.control.count) {
    EmitErrors("settled_error", s.settled, yaml);
  }
  if (s.control.count > 0) {
    YamlPairs(yaml, "best_run_rms_N", s.best_rms_N, "worst_run_rms_N",
              s.worst_rms_N, "controlled_percent", percent(s.controlled));
  }
  EmitErrors("estimate_error", s.estimate, yaml);
  YamlPair(yaml, "sure_percent", percent(s.estimate.count));
  if (result.lag_s) {
    YamlPair(yaml, "lag_ms", std::round(1e3 * *result.lag_s));
  }
  if (experiment.paper) {
    YamlPair(yaml, "beats_paper_rms",
             s.errors().rms() < experiment.paper->rms_N);
  }
  *yaml << YAML::EndMap;
}

}  // namespace

void ErrorSums::Add(const ErrorSums& other) {
  count += other.count;
  sum += other.sum;
  squares += other.squares;
  most = std::max(most, other.most);
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
  if (failure.empty()) failure = other.failure;
}

ControlStatistics StatisticsOf(const LoopRun& run, const Experiment& experiment,
                               bool controlled) {
  ControlStatistics statistics;
  statistics.runs = 1;
  statistics.failure = run.failure;
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
  std::mutex progress_mutex;
  tbb::task_arena(std::max(1, threads)).execute([&] {
    tbb::parallel_for(std::size_t{0}, each.size(), [&](std::size_t i) {
      const std::size_t c = i / draws, draw = i % draws;
      const ControllerSettings& controller = experiment.controllers[c];
      LoopRun run =
          RunLoop(finger, experiment, controller, discretization, seed + draw);
      each[i] = StatisticsOf(run, experiment,
                             controller.kind != ControllerKind::kNone);
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
    }
    if (result.controller.kind != ControllerKind::kNone &&
        experiment.set_point.amplitude != 0 &&
        !experiment.set_point.triangular) {
      result.lag_s = LagSeconds(result.first, experiment);
    }
  }
  return results;
}

std::vector<std::string> ControlLogNames(const Experiment& experiment,
                                         const ControllerSettings& controller) {
  const std::string stem = experiment.name + "." + controller.name;
  if (!experiment.mechanism.is_gripper()) return {stem + ".csv"};
  return {stem + ".finger_1.csv", stem + ".finger_2.csv"};
}

FrameTable ControlLog(const Finger& finger, const Experiment& experiment,
                      const LoopRun& run, int finger_index) {
  FrameTable log(run.rows.size());
  const auto fill = [&](const std::string& name, auto value) {
    std::vector<double>& cells = log.MutableNumbers(name);
    for (std::size_t i = 0; i < run.rows.size(); ++i) {
      cells[i] = value(run.rows[i]);
    }
  };
  const bool gripper = experiment.mechanism.is_gripper();
  const double unit = gripper ? 180 / M_PI : 1;
  const std::string drive = gripper ? "motor" : "stage";
  const std::string suffix = gripper ? "_deg" : "_mm";
  const int f = finger_index;
  using Row = const LoopRow&;
  fill("time_s", [](Row r) { return r.time_s; });
  fill("set_point_N", [](Row r) { return r.set_point_N; });
  fill("force_N", [](Row r) { return r.force_N; });
  fill("force_estimate_N", [](Row r) { return r.seen.force_N; });
  fill("force_estimate_std_N", [](Row r) { return r.seen.std_N; });
  fill(drive + suffix, [&](Row r) { return unit * r.drive; });
  fill(drive + "_command" + suffix, [&](Row r) { return unit * r.command; });
  fill("object_motion_mm", [](Row r) { return r.object_motion_mm; });
  const auto object = [&](Row r) { return r.fingers[f].object; };
  fill("object_x_mm", [&](Row r) { return object(r).position_mm.x(); });
  fill("object_y_mm", [&](Row r) { return object(r).position_mm.y(); });
  fill("object_angle_deg",
       [&](Row r) { return object(r).angle_rad * 180 / M_PI; });
  if (experiment.scene.object->spring) {
    fill("object_displacement_mm",
         [&](Row r) { return r.fingers[f].displacement_mm; });
  }
  for (std::size_t j = 0; j < finger.gauges.size(); ++j) {
    fill(GaugeVolts(static_cast<int>(j)),
         [&](Row r) { return r.readings[f].gauges_V[j]; });
  }
  Scene one = experiment.scene;
  one.contacts = 1;
  const ResultColumns columns(finger, one);
  std::vector<double> values(columns.names().size());
  for (std::size_t i = 0; i < run.rows.size(); ++i) {
    columns.Values(run.rows[i].readings[f], run.rows[i].estimates[f],
                   values.data());
    for (std::size_t c = 0; c < values.size(); ++c) {
      log.MutableNumbers(columns.names()[c])[i] = values[c];
    }
  }
  std::vector<std::string>& mode = log.MutableText("mode");
  std::vector<std::string>& status = log.MutableText("status");
  for (std::size_t i = 0; i < run.rows.size(); ++i) {
    mode[i] = LoopModeName(run.rows[i].mode);
    status[i] = StatusName(run.rows[i].estimates[f].status);
  }
  return log;
}

void EmitExperiment(const std::string& path, const Experiment& experiment,
                    const std::vector<ControllerResult>& results,
                    YamlEmitter* yaml) {
  *yaml << YAML::BeginMap;
  YamlPairs(yaml, "name", experiment.name, "experiment", path, "simulated",
            true);
  if (experiment.paper) {
    *yaml << Key << "paper" << Value;
    YamlLine(yaml, "figure", experiment.paper->figure, "rms_N",
             experiment.paper->rms_N, "max_N", experiment.paper->max_N);
  }
  *yaml << Key << "settings" << Value;
  EmitSettings(experiment, yaml);
  *yaml << Key << "controllers" << Value << YAML::BeginSeq;
  for (const ControllerResult& result : results) {
    EmitController(experiment, result, yaml);
  }
  *yaml << YAML::EndSeq << YAML::EndMap;
}

}  // namespace finray
