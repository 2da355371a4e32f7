#include "finray/calib/report/calibration_checks_yaml.h"

#include "finray/calib/report/yaml_rows.h"

namespace finray {
namespace {

void EmitErrors(const CalibrationResult& result, YamlEmitter* yaml) {
  *yaml << YAML::Key << "errors" << YAML::Value << YAML::BeginMap;
  const std::pair<const char*, const CalibrationResult::Errors*> parts[] = {
      {"fitted", &result.fitted}, {"held_out", &result.held_out}};
  for (const auto& [name, errors] : parts) {
    if (errors->after.contact.frames + errors->after.free.frames == 0) continue;
    *yaml << YAML::Key << name << YAML::Value << YAML::BeginMap;
    *yaml << YAML::Key << "before" << YAML::Value;
    EmitErrorTable(errors->before, yaml);
    *yaml << YAML::Key << "after" << YAML::Value;
    EmitErrorTable(errors->after, yaml);
    *yaml << YAML::EndMap;
  }
  *yaml << YAML::EndMap;
}

void EmitCorrelation(CalibrationProblem& problem,
                     const ResidualCorrelation& found, YamlEmitter* yaml) {
  *yaml << YAML::Key << "residual_correlation" << YAML::Value << YAML::BeginMap;
  EmitPairs(yaml, "correlated", found.correlated(), "p_value", found.p_value);
  *yaml << YAML::Key << "series" << YAML::Value << YAML::BeginSeq;
  for (const ResidualCorrelation::Series& series : found.series) {
    *yaml << YAML::Flow << YAML::BeginMap;
    EmitPairs(yaml, "log", problem.logs().paths[series.log], "family",
              ResidualFamilyName(series.family));
    if (series.gauge >= 0) YamlPair(yaml, "gauge", series.gauge + 1);
    EmitPairs(yaml, "component", series.component + 1, "residuals",
              series.time.n, "lag_1", series.time.lag_1, "integrated_time_rows",
              series.time.tau, "effective_residuals", series.time.effective());
    *yaml << YAML::EndMap;
  }
  *yaml << YAML::EndSeq << YAML::Key << "std_enlarged_by" << YAML::Value
        << YAML::Flow << YAML::BeginMap;
  const CalibrationParameters& parameters = problem.parameters();
  for (std::size_t i = 0; found.enlarges() && i < found.enlargement.size();
       ++i) {
    YamlPair(yaml, parameters.FreeParameter(i).name, found.enlargement[i]);
  }
  *yaml << YAML::EndMap << YAML::EndMap;
}

void EmitLeaveOneLogOut(CalibrationProblem& problem,
                        const LeaveOneLogOut& found, YamlEmitter* yaml) {
  if (found.groups == 0) return;
  *yaml << YAML::Key << "leave_one_log_out" << YAML::Value << YAML::BeginMap;
  EmitPairs(yaml, "groups", found.groups, "all_converged", found.all_converged);
  *yaml << YAML::Key << "parameters" << YAML::Value << YAML::BeginSeq;
  for (const LeaveOneLogOut::Row& row : found.rows) {
    EmitRow(yaml, "name", problem.parameters().all()[row.parameter].name,
            "spread", row.spread, "std", row.std, "spread_over_std",
            row.ratio(), "p_value", row.p_value);
  }
  *yaml << YAML::EndSeq << YAML::EndMap;
}

void EmitNext(CalibrationProblem& problem,
              const std::vector<FrameAdvice>& advised, YamlEmitter* yaml) {
  *yaml << YAML::Key << "next" << YAML::Value << YAML::BeginSeq;
  for (const FrameAdvice& advice : advised) {
    *yaml << YAML::BeginMap;
    EmitPairs(yaml, "words", advice.words, "kind",
              advice.known_gains ? "known_gains"
              : advice.free      ? "free_frames"
                                 : "contact_frames");
    if (!advice.known_gains) YamlPair(yaml, "frames", FrameAdvice::kFrames);
    if (!advice.known_gains && !advice.free) {
      // NaN means that the frames spread over the finger.
      EmitPairs(yaml, "contact_mm", advice.contact_mm, "normal_N",
                advice.normal_N);
    }
    *yaml << YAML::Key << "add" << YAML::Value << YAML::Flow << YAML::BeginSeq;
    for (const ResidualFamily family : advice.added) {
      *yaml << ResidualFamilyName(family);
    }
    *yaml << YAML::EndSeq;
    EmitPairs(
        yaml, "parameter", problem.parameters().all()[advice.parameter].name,
        "std_before", advice.parameter_std_before, "std_after",
        advice.parameter_std_after, "direction_std_ratio", advice.ratio());
    *yaml << YAML::EndMap;
  }
  *yaml << YAML::EndSeq;
}

void EmitStarts(const std::vector<StartReport>& starts, YamlEmitter* yaml) {
  *yaml << YAML::Key << "starts" << YAML::Value << YAML::BeginSeq;
  for (const StartReport& start : starts) {
    EmitRow(yaml, "start", start.name, "converged", start.converged,
            "iterations", start.iterations, "cost", start.cost, "distance_std",
            start.distance_std, "agrees", start.agrees);
  }
  *yaml << YAML::EndSeq;
}

void EmitRejected(const CalibrationProblem& problem, YamlEmitter* yaml) {
  *yaml << YAML::Key << "rejected_frames" << YAML::Value << YAML::BeginSeq;
  for (const auto& [index, reason] : problem.rejected()) {
    const CalibrationFrame& frame = problem.logs().frames[index];
    EmitRow(yaml, "log", problem.logs().paths[frame.log], "row", frame.row + 1,
            "reason", reason);
  }
  *yaml << YAML::EndSeq;
}

}  // namespace

void EmitChecks(CalibrationProblem& problem, const CalibrationResult& result,
                YamlEmitter* yaml) {
  EmitStarts(result.solution.starts, yaml);
  EmitRejected(problem, yaml);
  EmitErrors(result, yaml);
  EmitCorrelation(problem, result.residual_correlation, yaml);
  EmitLeaveOneLogOut(problem, result.leave_one_log_out, yaml);
  EmitNext(problem, result.next, yaml);
}

}  // namespace finray
