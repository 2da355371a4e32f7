#include <ceres/version.h>

#include <cmath>

#include "finray/calib/report/calibration_checks_yaml.h"
#include "finray/calib/report/calibration_result.h"
#include "finray/calib/report/yaml_rows.h"

namespace finray {
namespace {

void EmitParameters(CalibrationProblem& problem, const Identifiability& found,
                    YamlEmitter* yaml) {
  *yaml << YAML::Key << "parameters" << YAML::Value << YAML::BeginSeq;
  const CalibrationParameters& parameters = problem.parameters();
  std::size_t free = 0;
  for (std::size_t i = 0; i < parameters.all().size(); ++i) {
    const CalibrationParameter& p = parameters.all()[i];
    const bool is_free = free < parameters.free().size() &&
                         parameters.free()[free] == static_cast<int>(i);
    EmitRow(yaml, "name", p.name, "unit", p.unit, "initial", p.Value(p.initial),
            "value", p.Value(*p.variable), "std",
            is_free ? p.ValueStd(*p.variable, found.std[free]) : 0.0,
            "prior_std",
            p.prior_std ? p.ValueStd(p.initial, *p.prior_std) : std::nan(""),
            "status",
            ParameterStatusName(is_free ? found.status[free]
                                        : ParameterStatus::kFixed));
    free += is_free;
  }
  *yaml << YAML::EndSeq;
}

void EmitWeakDirections(CalibrationProblem& problem,
                        const Identifiability& found, YamlEmitter* yaml) {
  *yaml << YAML::Key << "weak_directions" << YAML::Value << YAML::BeginSeq;
  for (const WeakDirection& weak : found.weak) {
    *yaml << YAML::BeginMap;
    EmitPairs(yaml, "words", weak.words, "how_far", weak.how_far, "remedy",
              weak.remedy, "std_over_prior", weak.std_over_prior);
    *yaml << YAML::Key << "components" << YAML::Value << YAML::Flow
          << YAML::BeginMap;
    for (const auto& component : weak.components) {
      YamlPair(yaml,
               problem.parameters().all()[component.parameter].name.c_str(),
               component.share);
    }
    *yaml << YAML::EndMap << YAML::EndMap;
  }
  *yaml << YAML::EndSeq;
}

void EmitCorrelations(CalibrationProblem& problem, const Identifiability& found,
                      YamlEmitter* yaml) {
  const CalibrationParameters& parameters = problem.parameters();
  *yaml << YAML::Key << "correlations" << YAML::Value << YAML::BeginMap;
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
  *yaml << YAML::Key << "noise" << YAML::Value << YAML::BeginMap;
  for (int i = 0; i < kResidualFamilies; ++i) {
    const Identifiability::Noise& noise = found.noise[i];
    if (noise.residuals == 0) continue;
    *yaml << YAML::Key << ResidualFamilyName(static_cast<ResidualFamily>(i))
          << YAML::Value << YAML::Flow << YAML::BeginMap;
    EmitPairs(yaml, "residuals", noise.residuals, "dof", noise.dof, "chi2",
              noise.chi2);
    // The ratio means nothing without spare measurements.
    YamlPair(yaml, "chi2_per_dof",
             noise.dof > 0.5 ? noise.chi2 / noise.dof : std::nan(""));
    *yaml << YAML::EndMap;
  }
  *yaml << YAML::EndMap;
}

void EmitBench(const std::vector<BenchLinearity>& bench, YamlEmitter* yaml) {
  if (bench.empty()) return;
  EmitSeq(yaml, "bench", bench, [&](const BenchLinearity& of_gauge) {
    *yaml << YAML::BeginMap;
    EmitPairs(yaml, "gauge", of_gauge.gauge + 1, "readings", of_gauge.readings,
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

void EmitForceError(const ForceCheck::Error& error, YamlEmitter* yaml) {
  *yaml << YAML::Flow << YAML::BeginMap;
  YamlPair(yaml, "frames", error.frames);
  if (error.frames > 0) {
    if (error.frames_before > 0) {
      EmitPairs(yaml, "force_rms_error_before_N", error.before_rms_N,
                "frames_before", error.frames_before);
    }
    EmitPairs(yaml, "force_rms_error_after_N", error.after_rms_N,
              "force_max_error_after_N", error.after_max_N, "force_mean_N",
              error.reference_mean_N);
  }
  *yaml << YAML::EndMap;
}

void EmitInputs(const CalibrationInputs& inputs, YamlEmitter* yaml) {
  *yaml << YAML::Key << "inputs" << YAML::Value << YAML::BeginMap;
  EmitFile(yaml, "finger", inputs.finger_path);
  EmitFile(yaml, "plan", inputs.plan_path);
  EmitSeq(yaml, "logs", inputs.log_paths,
          [&](const std::string& path) { EmitFile(yaml, path); });
  *yaml << YAML::EndMap;
}

void EmitConfig(const Plan& plan, const CalibrationInputs& inputs,
                YamlEmitter* yaml) {
  constexpr const char* kLosses[] = {"none", "huber", "cauchy"};
  *yaml << YAML::Key << "config" << YAML::Value << YAML::BeginMap;
  EmitPairs(
      yaml, "command", inputs.command, "scheme", inputs.scheme, "resolution",
      inputs.resolution, "contacts",
      plan.scene.contacts ? std::to_string(*plan.scene.contacts) : "auto");
  if (!plan.scene.contact_beams.empty()) {
    YamlPair(yaml, "contact_beams", YAML::Load(ContactBeamsToYaml(plan.scene)));
  }
  YamlPair(yaml, "friction_coefficient", plan.scene.friction_coefficient);
  if (plan.scene.circle_radius_mm()) {
    YamlPair(yaml, "circle_radius_mm", *plan.scene.circle_radius_mm());
  }
  YamlPair(yaml, "force_std_N", plan.force_std_N);
  if (plan.gauge_std_V) YamlPair(yaml, "gauge_std_V", *plan.gauge_std_V);
  EmitPairs(yaml, "object_std_mm", plan.object_std_mm, "contact_std_mm",
            plan.contact_std_mm);
  if (plan.pin_std_mm) YamlPair(yaml, "pin_std_mm", *plan.pin_std_mm);
  if (plan.tip_std_mm) YamlPair(yaml, "tip_std_mm", *plan.tip_std_mm);
  if (plan.family(ParameterFamily::kTemperatureCoefficient).free) {
    YamlPair(yaml, "reference_C", plan.reference_temperature_C);
  }
  if (plan.gauge_walk) {
    EmitPairs(yaml, "walk_std_V_per_sqrt_h", plan.gauge_walk->std_V_per_sqrt_h,
              "knot_every_s", plan.gauge_walk->knot_every_s);
  }
  EmitPairs(yaml, "robust_loss", kLosses[static_cast<int>(plan.loss)],
            "robust_scale", plan.loss_scale);
  *yaml << YAML::EndMap;
}

}  // namespace

std::string CalibrationYaml(CalibrationProblem& problem,
                            const CalibrationResult& result,
                            const CalibrationInputs& inputs) {
  YamlEmitter yaml;
  yaml << YAML::BeginMap;
  EmitPairs(&yaml, "schema_version", 1, "finger", problem.finger().name,
            "verdict", result.Verdict());
  EmitParameters(problem, result.identifiability, &yaml);
  EmitWeakDirections(problem, result.identifiability, &yaml);
  EmitCorrelations(problem, result.identifiability, &yaml);
  EmitNoise(result.identifiability, &yaml);
  EmitBench(result.bench, &yaml);
  yaml << YAML::Key << "fit" << YAML::Value;
  EmitForceError(result.forces.fitted, &yaml);
  yaml << YAML::Key << "holdout" << YAML::Value;
  EmitForceError(result.forces.held_out, &yaml);
  EmitChecks(problem, result, &yaml);
  EmitSeq(&yaml, "warnings", result.warnings, [&](const auto& warning) {
    yaml << YAML::BeginMap;
    EmitPairs(&yaml, "code", warning.code, "text", warning.text, "remedy",
              warning.remedy);
    yaml << YAML::EndMap;
  });
  yaml << YAML::Key << "solver" << YAML::Value;
  EmitRow(&yaml, "converged", result.solution.solve.converged, "iterations",
          result.solution.solve.iterations, "initial_cost",
          result.solution.solve.initial_cost, "final_cost",
          result.solution.solve.final_cost);
  EmitInputs(inputs, &yaml);
  EmitConfig(problem.plan(), inputs, &yaml);
  yaml << YAML::Key << "versions" << YAML::Value;
  EmitRow(&yaml, "finray", FINRAY_VERSION, "ceres", CERES_VERSION_STRING);
  yaml << YAML::EndMap;
  return std::string(yaml.c_str()) + "\n";
}

}  // namespace finray
