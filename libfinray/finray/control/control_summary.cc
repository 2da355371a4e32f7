#include "finray/control/control_summary.h"

#include <cmath>

#include "finray/control/experiment_settings.h"
#include "finray/io/yaml_emitter.h"

namespace finray {
namespace {

using YAML::Key;
using YAML::Value;

void EmitErrors(const char* name, const ErrorSums& errors, YamlEmitter* yaml) {
  if (errors.count == 0) return;
  *yaml << Key << name << Value << YAML::Flow << YAML::BeginMap << Key
        << "periods" << Value << errors.count << Key << "rms_N" << Value
        << errors.rms() << Key << "max_N" << Value << errors.most << Key
        << "mean_N" << Value << errors.mean() << YAML::EndMap;
}

void EmitController(const Experiment& experiment,
                    const ControllerResult& result, YamlEmitter* yaml) {
  const ControlStatistics& s = result.statistics;
  *yaml << YAML::BeginMap << Key << "name" << Value << result.controller.name;
  *yaml << Key << "preview" << Value << result.controller.preview;
  *yaml << Key << "logs" << Value << YAML::Flow
        << ControlLogNames(experiment, result.controller);
  *yaml << Key << "runs" << Value << s.runs << Key << "failed_runs" << Value
        << s.failed_runs << Key << "stopped_runs" << Value << s.stopped_runs;
  if (!result.failure.empty()) {
    *yaml << Key << "failure" << Value << result.failure;
  }
  EmitErrors("control_error", s.control, yaml);
  if (s.settled.count != s.control.count) {
    EmitErrors("settled_error", s.settled, yaml);
  }
  if (s.control.count > 0) {
    *yaml << Key << "best_run_rms_N" << Value << s.best_rms_N << Key
          << "worst_run_rms_N" << Value << s.worst_rms_N << Key
          << "controlled_percent" << Value
          << 100.0 * static_cast<double>(s.controlled) /
                 static_cast<double>(s.periods);
  }
  EmitErrors("estimate_error", s.estimate, yaml);
  *yaml << Key << "sure_percent" << Value
        << 100.0 * static_cast<double>(s.estimate.count) /
               static_cast<double>(s.periods);
  if (result.lag_s) {
    *yaml << Key << "lag_ms" << Value << std::round(1e3 * *result.lag_s);
  }
  if (experiment.paper) {
    const ErrorSums& errors = s.control.count > 0 ? s.control : s.estimate;
    *yaml << Key << "beats_paper_rms" << Value
          << (errors.rms() < experiment.paper->rms_N);
  }
  *yaml << YAML::EndMap;
}

}  // namespace

std::vector<std::string> ControlLogNames(const Experiment& experiment,
                                         const ControllerSettings& controller) {
  const std::string stem = experiment.name + "." + controller.name;
  if (!experiment.mechanism.is_gripper()) return {stem + ".csv"};
  return {stem + ".finger_1.csv", stem + ".finger_2.csv"};
}

void EmitExperiment(const std::string& path, const Experiment& experiment,
                    const std::vector<ControllerResult>& results,
                    YamlEmitter* yaml) {
  *yaml << YAML::BeginMap << Key << "name" << Value << experiment.name << Key
        << "experiment" << Value << path << Key << "simulated" << Value << true;
  if (experiment.paper) {
    *yaml << Key << "paper" << Value << YAML::Flow << YAML::BeginMap << Key
          << "figure" << Value << experiment.paper->figure << Key << "rms_N"
          << Value << experiment.paper->rms_N << Key << "max_N" << Value
          << experiment.paper->max_N << YAML::EndMap;
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
