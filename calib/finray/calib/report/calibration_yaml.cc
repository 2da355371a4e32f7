#include <ceres/version.h>

#include <cmath>

#include "finray/calib/report/calibration_result.h"
#include "finray/calib/report/yaml_rows.h"
#include "finray/io/versions.h"

namespace finray {
namespace {

void EmitParameters(CalibrationProblem& problem, const Identifiability& found,
                    YamlEmitter* yaml) {
  std::size_t free = 0;
  EmitSeq(yaml, "parameters", problem.parameters().all(), [&](const auto& p) {
    YamlLine(yaml, "name", p.name, "unit", p.unit, "initial",
             p.Value(p.initial), "value", p.Value(*p.variable), "std",
             p.free ? p.ValueStd(*p.variable, found.std[free]) : 0.0,
             "prior_std",
             p.prior_std ? p.ValueStd(p.initial, *p.prior_std) : std::nan(""),
             "prior_stds_off",
             p.prior_std && p.free ? (*p.variable - p.initial) / *p.prior_std
                                   : std::nan(""),
             "status",
             ParameterStatusName(p.free ? found.status[free]
                                        : ParameterStatus::kFixed));
    free += p.free;
  });
}

void EmitWeakDirections(CalibrationProblem& problem,
                        const Identifiability& found, YamlEmitter* yaml) {
  EmitSeq(yaml, "weak_directions", found.weak, [&](const WeakDirection& weak) {
    *yaml << YAML::BeginMap;
    YamlPairs(yaml, "words", weak.words, "how_far", weak.how_far, "remedy",
              weak.remedy, "std_over_prior", weak.std_over_prior);
    BeginLine(yaml, "components");
    for (const auto& component : weak.components) {
      YamlPair(yaml,
               problem.parameters().all()[component.parameter].name.c_str(),
               component.share);
    }
    *yaml << YAML::EndMap << YAML::EndMap;
  });
}

void EmitCorrelations(CalibrationProblem& problem, const Identifiability& found,
                      YamlEmitter* yaml) {
  const CalibrationParameters& parameters = problem.parameters();
  BeginMap(yaml, "correlations");
  *yaml << YAML::Key << "names" << YAML::Value << YAML::Flow << YAML::BeginSeq;
  for (const int i : parameters.free()) *yaml << parameters.all()[i].name;
  *yaml << YAML::EndSeq << YAML::Key << "matrix" << YAML::Value
        << YAML::BeginSeq;
  for (int i = 0; i < found.correlation.rows(); ++i) {
    *yaml << YAML::Flow << YAML::BeginSeq;
    for (int j = 0; j < found.correlation.cols(); ++j) {
      *yaml << std::round(found.correlation(i, j) * 1e6) / 1e6;
    }
    *yaml << YAML::EndSeq;
  }
  *yaml << YAML::EndSeq << YAML::EndMap;
}

void EmitNoise(const Identifiability& found, YamlEmitter* yaml) {
  BeginMap(yaml, "noise");
  for (int i = 0; i < kResidualFamilies; ++i) {
    const Identifiability::Noise& noise = found.noise[i];
    if (noise.residuals == 0) continue;
    // The ratio means nothing without spare measurements.
    EmitLine(yaml, ResidualFamilyName(static_cast<ResidualFamily>(i)),
             "residuals", noise.residuals, "dof", noise.dof, "chi2", noise.chi2,
             "chi2_per_dof",
             noise.dof > 0.5 ? noise.chi2 / noise.dof : std::nan(""));
  }
  *yaml << YAML::EndMap;
}

void EmitFreeScatter(const CalibrationProblem& problem,
                     const std::vector<FreeScatter>& scatter,
                     YamlEmitter* yaml) {
  EmitSeq(yaml, "free_scatter", scatter, [&](const FreeScatter& of_gauge) {
    YamlLine(yaml, "gauge", of_gauge.gauge + 1, "std_V", of_gauge.std_V,
             "differences", of_gauge.differences, "noise_V",
             problem.finger().gauges[of_gauge.gauge].noise_V);
  });
}

void EmitBench(const std::vector<BenchLinearity>& bench, YamlEmitter* yaml) {
  if (bench.empty()) return;
  EmitSeq(yaml, "bench", bench, [&](const BenchLinearity& of_gauge) {
    *yaml << YAML::BeginMap;
    YamlPairs(yaml, "gauge", of_gauge.gauge + 1, "readings", of_gauge.readings,
              "linear", of_gauge.IsLinear(), "largest_angle_rad",
              of_gauge.largest_angle_rad, "quadratic_V_per_rad2",
              of_gauge.quadratic_V_per_rad2, "quadratic_std",
              of_gauge.quadratic_std, "quadratic_p_value",
              of_gauge.quadratic_p_value, "lack_of_fit_F",
              of_gauge.lack_of_fit_F, "lack_of_fit_p_value",
              of_gauge.lack_of_fit_p_value);
    *yaml << YAML::EndMap;
  });
}

void EmitForceErrors(const char* key, const ForceCheck::Errors& errors,
                     YamlEmitter* yaml) {
  const ErrorStatistics& before = errors.force_before_N();
  const ErrorStatistics& after = errors.force_after_N();
  BeginLine(yaml, key);
  YamlPair(yaml, "frames", after.frames);
  if (after.frames > 0) {
    if (before.frames > 0) {
      YamlPairs(yaml, "force_rms_error_before_N", before.rms(), "frames_before",
                before.frames);
    }
    YamlPairs(yaml, "force_rms_error_after_N", after.rms(),
              "force_max_error_after_N", after.largest, "force_mean_N",
              after.reference_mean());
  }
  *yaml << YAML::EndMap;
}

void EmitInputs(const CalibrationLogs& logs, const std::string& columns_path,
                const CalibrationInputs& inputs, YamlEmitter* yaml) {
  BeginMap(yaml, "inputs");
  const auto emit = [&](const char* key, const std::string& path) {
    EmitLine(yaml, key, "path", path, "sha256", inputs.Sha256Of(path));
  };
  emit("finger", inputs.finger_path);
  emit("plan", inputs.plan_path);
  if (!columns_path.empty()) emit("columns", columns_path);
  const auto emit_log = [&](const std::string& path) {
    YamlLine(yaml, "path", path, "sha256", inputs.Sha256Of(path));
  };
  EmitSeq(yaml, "logs", logs.paths, emit_log);
  if (!logs.left_out.empty()) {
    EmitSeq(yaml, "left_out", logs.left_out, emit_log);
  }
  *yaml << YAML::EndMap;
}

void EmitConfig(const Plan& plan, const CalibrationInputs& inputs,
                YamlEmitter* yaml) {
  constexpr const char* kLosses[] = {"none", "huber", "cauchy"};
  BeginMap(yaml, "config");
  YamlPairs(
      yaml, "command", inputs.command, "scheme", inputs.scheme, "resolution",
      inputs.resolution, "contacts",
      plan.scene.contacts ? std::to_string(*plan.scene.contacts) : "auto");
  if (!plan.scene.contact_beams.empty()) {
    YamlPair(yaml, "contact_beams", YAML::Load(ContactBeamsToYaml(plan.scene)));
  }
  YamlPair(yaml, "friction_coefficient", plan.scene.friction_coefficient);
  if (plan.scene.presliding_mm) {
    YamlPair(yaml, "presliding_mm", *plan.scene.presliding_mm);
  }
  if (plan.scene.circle_radius_mm()) {
    YamlPair(yaml, "circle_radius_mm", *plan.scene.circle_radius_mm());
  }
  YamlPair(yaml, "force_std_N", plan.force_std_N);
  if (plan.gauge_std_V) YamlPair(yaml, "gauge_std_V", *plan.gauge_std_V);
  YamlPairs(yaml, "object_std_mm", plan.object_std_mm, "contact_std_mm",
            plan.contact_std_mm);
  if (plan.pin_std_mm) YamlPair(yaml, "pin_std_mm", *plan.pin_std_mm);
  if (plan.tip_std_mm) YamlPair(yaml, "tip_std_mm", *plan.tip_std_mm);
  if (plan.family(ParameterFamily::kTemperatureCoefficient).free) {
    YamlPair(yaml, "reference_C", plan.reference_temperature_C);
  }
  if (plan.gauge_walk) {
    YamlPairs(yaml, "walk_std_V_per_sqrt_h", plan.gauge_walk->std_V_per_sqrt_h,
              "knot_every_s", plan.gauge_walk->knot_every_s);
  }
  YamlPairs(yaml, "robust_loss", kLosses[static_cast<int>(plan.loss)],
            "robust_scale", plan.loss_scale);
  *yaml << YAML::EndMap;
}

void EmitErrors(const ForceCheck& forces, YamlEmitter* yaml) {
  BeginMap(yaml, "errors");
  const std::pair<const char*, const ForceCheck::Errors*> parts[] = {
      {"fitted", &forces.fitted}, {"held_out", &forces.held_out}};
  for (const auto& [name, errors] : parts) {
    if (errors->after.contact.frames + errors->after.free.frames == 0) continue;
    BeginMap(yaml, name);
    EmitErrorTable("before", errors->before, yaml);
    EmitErrorTable("after", errors->after, yaml);
    *yaml << YAML::EndMap;
  }
  *yaml << YAML::EndMap;
}

void EmitCorrelation(CalibrationProblem& problem,
                     const ResidualCorrelation& found, YamlEmitter* yaml) {
  BeginMap(yaml, "residual_correlation");
  YamlPairs(yaml, "correlated", found.correlated(), "p_value", found.p_value);
  EmitSeq(yaml, "series", found.series, [&](const auto& series) {
    *yaml << YAML::Flow << YAML::BeginMap;
    YamlPairs(yaml, "log", problem.logs().paths[series.log], "family",
              ResidualFamilyName(series.family));
    if (series.gauge >= 0) YamlPair(yaml, "gauge", series.gauge + 1);
    YamlPairs(yaml, "component", series.component + 1, "residuals",
              series.time.n, "lag_1", series.time.lag_1, "integrated_time_rows",
              series.time.tau, "effective_residuals", series.time.effective());
    *yaml << YAML::EndMap;
  });
  BeginLine(yaml, "std_enlarged_by");
  const CalibrationParameters& parameters = problem.parameters();
  for (std::size_t i = 0; found.enlarges() && i < found.enlargement.size();
       ++i) {
    YamlPair(yaml, parameters.FreeParameter(i).name, found.enlargement[i]);
  }
  *yaml << YAML::EndMap << YAML::EndMap;
}

void EmitEffect(const ScoreTest::Effect& effect, YamlEmitter* yaml) {
  *yaml << YAML::BeginMap;
  YamlPairs(yaml, "family", FamilyKeyOf(effect.family), "words", effect.words,
            "chi2_drop", effect.drop, "evidence", effect.evidence, "p_value",
            effect.p_value, "significant", effect.significant);
  EmitSeq(yaml, "values", effect.values, [&](const auto& value) {
    YamlLine(yaml, "name", value.name, "unit", value.unit, "value", value.value,
             "std", value.std, "change", value.change);
  });
  *yaml << YAML::EndMap;
}

void EmitScore(const ScoreTest& score, YamlEmitter* yaml) {
  BeginMap(yaml, "effect_scores");
  YamlPair(yaml, "words", score.Words());
  const auto emit = [&](const auto& effect) { EmitEffect(effect, yaml); };
  EmitSeq(yaml, "effects", score.effects, emit);
  *yaml << YAML::Key << "alike" << YAML::Value << YAML::Flow << YAML::BeginSeq;
  for (const auto& effect : score.alike) *yaml << FamilyKeyOf(effect.family);
  *yaml << YAML::EndSeq;
  if (score.next) {
    *yaml << YAML::Key << "next" << YAML::Value;
    emit(*score.next);
  }
  *yaml << YAML::EndMap;
}

void EmitLeaveOneLogOut(CalibrationProblem& problem,
                        const LeaveOneLogOut& found, YamlEmitter* yaml) {
  if (found.groups == 0) return;
  BeginMap(yaml, "leave_one_log_out");
  YamlPairs(yaml, "groups", found.groups, "all_converged", found.all_converged);
  EmitSeq(yaml, "parameters", found.rows, [&](const auto& row) {
    YamlLine(yaml, "name", problem.parameters().all()[row.parameter].name,
             "spread", row.spread, "std", row.std, "spread_over_std",
             row.ratio(), "p_value", row.p_value);
  });
  *yaml << YAML::EndMap;
}

void EmitPlaces(const std::vector<Eigen::Vector2d>& object_mm,
                YamlEmitter* yaml) {
  for (int axis = 0; axis < 2; ++axis) {
    *yaml << YAML::Key << (axis == 0 ? "object_x_mm" : "object_y_mm")
          << YAML::Value << YAML::Flow << YAML::BeginSeq;
    for (const Eigen::Vector2d& place : object_mm) *yaml << place[axis];
    *yaml << YAML::EndSeq;
  }
}

void EmitNext(CalibrationProblem& problem,
              const std::vector<FrameAdvice>& advised, YamlEmitter* yaml) {
  EmitSeq(yaml, "next", advised, [&](const FrameAdvice& advice) {
    *yaml << YAML::BeginMap;
    YamlPairs(yaml, "words", advice.words, "kind",
              advice.known_gains ? "known_gains"
              : advice.free      ? "free_frames"
                                 : "contact_frames");
    if (!advice.known_gains) YamlPair(yaml, "frames", FrameAdvice::kFrames);
    if (!advice.known_gains && !advice.free) {
      // NaN means that the frames spread over the finger.
      YamlPairs(yaml, "contact_mm", advice.contact_mm, "normal_N",
                advice.normal_N);
      EmitPlaces(advice.object_mm, yaml);
    }
    *yaml << YAML::Key << "add" << YAML::Value << YAML::Flow << YAML::BeginSeq;
    for (const ResidualFamily family : advice.added) {
      *yaml << ResidualFamilyName(family);
    }
    *yaml << YAML::EndSeq;
    YamlPairs(
        yaml, "parameter", problem.parameters().all()[advice.parameter].name,
        "std_before", advice.parameter_std_before, "std_after",
        advice.parameter_std_after, "direction_std_ratio", advice.ratio());
    if (advice.force_std_after_N) {
      YamlPairs(yaml, "force_std_before_N", *advice.force_std_before_N,
                "force_std_after_N", *advice.force_std_after_N);
    }
    *yaml << YAML::EndMap;
  });
}

}  // namespace

std::string CalibrationInputs::Sha256Of(const std::string& path) const {
  const auto text = texts.find(path);
  return text == texts.end() ? Sha256OfFile(path) : Sha256OfText(text->second);
}

std::string CalibrationYaml(CalibrationProblem& problem,
                            const CalibrationResult& result,
                            const CalibrationInputs& inputs) {
  YamlEmitter yaml;
  yaml << YAML::BeginMap;
  YamlPairs(&yaml, "schema_version", 1, "finger", problem.finger().name,
            "verdict", result.Verdict());
  yaml << YAML::Key << "doubts" << YAML::Value << result.doubts;
  EmitScore(result.score, &yaml);
  EmitParameters(problem, result.identifiability, &yaml);
  EmitWeakDirections(problem, result.identifiability, &yaml);
  EmitCorrelations(problem, result.identifiability, &yaml);
  YamlPair(&yaml, "effective_rows", result.effective_rows);
  EmitNoise(result.identifiability, &yaml);
  EmitFreeScatter(problem, result.free_scatter, &yaml);
  EmitBench(result.bench, &yaml);
  EmitForceErrors("fit", result.forces.fitted, &yaml);
  EmitForceErrors("holdout", result.forces.held_out, &yaml);
  EmitSeq(&yaml, "starts", result.solution.starts, [&](const auto& start) {
    YamlLine(&yaml, "start", start.name, "converged", start.solve.converged,
             "iterations", start.solve.iterations, "cost",
             start.solve.final_cost, "distance_std", start.distance_std,
             "agrees", start.agrees);
  });
  EmitSeq(&yaml, "rejected_frames", problem.rejected(), [&](const auto& its) {
    const CalibrationFrame& frame = problem.frame(its.first);
    YamlLine(&yaml, "log", problem.logs().paths[frame.log], "row",
             frame.row + 1, "reason", its.second);
  });
  EmitErrors(result.forces, &yaml);
  if (result.cross_validation.folds > 0) {
    EmitErrorTable("cross_validation", result.cross_validation.errors, &yaml);
  }
  EmitLine(&yaml, "discrepancy", "words",
           result.discrepancy ? WordsOf(*result.discrepancy) : "");
  EmitCorrelation(problem, result.residual_correlation, &yaml);
  EmitLeaveOneLogOut(problem, result.leave_one_log_out, &yaml);
  const NextRecording& next = result.next;
  EmitLine(&yaml, "predicted_force", "std_N", next.force_std_N(),
           "calibration_N", next.force_calibration_N, "noise_N",
           next.force_noise_N, "contacts", next.force_contacts, "enough",
           next.enough, "words", NextWords(next));
  EmitNext(problem, next.advice, &yaml);
  EmitSeq(&yaml, "warnings", result.warnings, [&](const auto& warning) {
    yaml << YAML::BeginMap;
    YamlPairs(&yaml, "code", warning.code, "text", warning.text, "remedy",
              warning.remedy);
    yaml << YAML::EndMap;
  });
  const SolveReport& solve = result.solution.solve;
  EmitLine(&yaml, "solver", "converged", solve.converged, "iterations",
           solve.iterations, "initial_cost", solve.initial_cost, "final_cost",
           solve.final_cost);
  EmitInputs(problem.logs(), problem.plan().columns.path, inputs, &yaml);
  EmitConfig(problem.plan(), inputs, &yaml);
  EmitLine(&yaml, "versions", "finray", FINRAY_VERSION, "ceres",
           CERES_VERSION_STRING);
  yaml << YAML::EndMap;
  return std::string(yaml.c_str()) + "\n";
}

}  // namespace finray
