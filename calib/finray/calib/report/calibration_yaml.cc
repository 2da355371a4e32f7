#include <ceres/version.h>

#include <cmath>

#include "finray/calib/report/calibration_checks_yaml.h"
#include "finray/calib/report/calibration_result.h"
#include "finray/io/sha256.h"
#include "finray/io/yaml_emitter.h"

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
    *yaml << YAML::Flow << YAML::BeginMap;
    YamlPair(yaml, "name", p.name);
    YamlPair(yaml, "unit", p.unit);
    YamlPair(yaml, "initial", p.Value(p.initial));
    YamlPair(yaml, "value", p.Value(*p.variable));
    YamlPair(yaml, "std",
             is_free ? p.ValueStd(*p.variable, found.std[free]) : 0.0);
    YamlPair(yaml, "prior_std",
             p.prior_std ? p.ValueStd(p.initial, *p.prior_std) : std::nan(""));
    YamlPair(yaml, "status",
             ParameterStatusName(is_free ? found.status[free]
                                         : ParameterStatus::kFixed));
    *yaml << YAML::EndMap;
    free += is_free;
  }
  *yaml << YAML::EndSeq;
}

void EmitWeakDirections(CalibrationProblem& problem,
                        const Identifiability& found, YamlEmitter* yaml) {
  *yaml << YAML::Key << "weak_directions" << YAML::Value << YAML::BeginSeq;
  for (const WeakDirection& weak : found.weak) {
    *yaml << YAML::BeginMap;
    YamlPair(yaml, "words", weak.words);
    YamlPair(yaml, "how_far", weak.how_far);
    YamlPair(yaml, "remedy", weak.remedy);
    YamlPair(yaml, "std_over_prior", weak.std_over_prior);
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
    YamlPair(yaml, "residuals", noise.residuals);
    YamlPair(yaml, "dof", noise.dof);
    YamlPair(yaml, "chi2", noise.chi2);
    // Without spare measurements the ratio would be noise over nothing.
    YamlPair(yaml, "chi2_per_dof",
             noise.dof > 0.5 ? noise.chi2 / noise.dof : std::nan(""));
    *yaml << YAML::EndMap;
  }
  *yaml << YAML::EndMap;
}

void EmitBench(const std::vector<BenchLinearity>& bench, YamlEmitter* yaml) {
  if (bench.empty()) return;
  *yaml << YAML::Key << "bench" << YAML::Value << YAML::BeginSeq;
  for (const BenchLinearity& of_gauge : bench) {
    *yaml << YAML::BeginMap;
    YamlPair(yaml, "gauge", of_gauge.gauge + 1);
    YamlPair(yaml, "readings", of_gauge.readings);
    YamlPair(yaml, "linear", of_gauge.IsLinear());
    YamlPair(yaml, "largest_angle_rad", of_gauge.largest_angle_rad);
    YamlPair(yaml, "quadratic_V_per_rad2", of_gauge.quadratic_V_per_rad2);
    YamlPair(yaml, "quadratic_std", of_gauge.quadratic_std);
    YamlPair(yaml, "quadratic_p_value", of_gauge.quadratic_p_value);
    YamlPair(yaml, "lack_of_fit_F", of_gauge.lack_of_fit_F);
    YamlPair(yaml, "lack_of_fit_p_value", of_gauge.lack_of_fit_p_value);
    *yaml << YAML::EndMap;
  }
  *yaml << YAML::EndSeq;
}

void EmitForceError(const ForceCheck::Error& error, YamlEmitter* yaml) {
  *yaml << YAML::Flow << YAML::BeginMap;
  YamlPair(yaml, "frames", error.frames);
  if (error.frames > 0) {
    if (error.frames_before > 0) {
      YamlPair(yaml, "force_rms_error_before_N", error.before_rms_N);
      YamlPair(yaml, "frames_before", error.frames_before);
    }
    YamlPair(yaml, "force_rms_error_after_N", error.after_rms_N);
    YamlPair(yaml, "force_max_error_after_N", error.after_max_N);
    YamlPair(yaml, "force_mean_N", error.reference_mean_N);
  }
  *yaml << YAML::EndMap;
}

void EmitInputs(const CalibrationInputs& inputs, YamlEmitter* yaml) {
  const auto file = [yaml](const std::string& path) {
    *yaml << YAML::Flow << YAML::BeginMap;
    YamlPair(yaml, "path", path);
    YamlPair(yaml, "sha256", Sha256OfFile(path));
    *yaml << YAML::EndMap;
  };
  *yaml << YAML::Key << "inputs" << YAML::Value << YAML::BeginMap;
  *yaml << YAML::Key << "finger" << YAML::Value;
  file(inputs.finger_path);
  *yaml << YAML::Key << "plan" << YAML::Value;
  file(inputs.plan_path);
  *yaml << YAML::Key << "logs" << YAML::Value << YAML::BeginSeq;
  for (const std::string& path : inputs.log_paths) file(path);
  *yaml << YAML::EndSeq << YAML::EndMap;
}

void EmitConfig(const Plan& plan, const CalibrationInputs& inputs,
                YamlEmitter* yaml) {
  constexpr const char* kLosses[] = {"none", "huber", "cauchy"};
  *yaml << YAML::Key << "config" << YAML::Value << YAML::BeginMap;
  YamlPair(yaml, "command", inputs.command);
  YamlPair(yaml, "scheme", inputs.scheme);
  YamlPair(yaml, "resolution", inputs.resolution);
  YamlPair(yaml, "contacts",
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
  YamlPair(yaml, "object_std_mm", plan.object_std_mm);
  YamlPair(yaml, "contact_std_mm", plan.contact_std_mm);
  if (plan.pin_std_mm) YamlPair(yaml, "pin_std_mm", *plan.pin_std_mm);
  if (plan.tip_std_mm) YamlPair(yaml, "tip_std_mm", *plan.tip_std_mm);
  if (plan.family(ParameterFamily::kTemperatureCoefficient).free) {
    YamlPair(yaml, "reference_C", plan.reference_temperature_C);
  }
  if (plan.gauge_walk) {
    YamlPair(yaml, "walk_std_V_per_sqrt_h", plan.gauge_walk->std_V_per_sqrt_h);
    YamlPair(yaml, "knot_every_s", plan.gauge_walk->knot_every_s);
  }
  YamlPair(yaml, "robust_loss", kLosses[static_cast<int>(plan.loss)]);
  YamlPair(yaml, "robust_scale", plan.loss_scale);
  *yaml << YAML::EndMap;
}

}  // namespace

std::string CalibrationYaml(CalibrationProblem& problem,
                            const CalibrationResult& result,
                            const CalibrationInputs& inputs) {
  YamlEmitter yaml;
  yaml << YAML::BeginMap;
  YamlPair(&yaml, "schema_version", 1);
  YamlPair(&yaml, "finger", problem.finger().name);
  YamlPair(&yaml, "verdict", result.Verdict());
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
  yaml << YAML::Key << "warnings" << YAML::Value << YAML::BeginSeq;
  for (const CalibrationWarning& warning : result.warnings) {
    yaml << YAML::BeginMap;
    YamlPair(&yaml, "code", warning.code);
    YamlPair(&yaml, "text", warning.text);
    YamlPair(&yaml, "remedy", warning.remedy);
    yaml << YAML::EndMap;
  }
  yaml << YAML::EndSeq;
  yaml << YAML::Key << "solver" << YAML::Value << YAML::Flow << YAML::BeginMap;
  YamlPair(&yaml, "converged", result.solution.solve.converged);
  YamlPair(&yaml, "iterations", result.solution.solve.iterations);
  YamlPair(&yaml, "initial_cost", result.solution.solve.initial_cost);
  YamlPair(&yaml, "final_cost", result.solution.solve.final_cost);
  yaml << YAML::EndMap;
  EmitInputs(inputs, &yaml);
  EmitConfig(problem.plan(), inputs, &yaml);
  yaml << YAML::Key << "versions" << YAML::Value << YAML::Flow
       << YAML::BeginMap;
  YamlPair(&yaml, "finray", FINRAY_VERSION);
  YamlPair(&yaml, "ceres", CERES_VERSION_STRING);
  yaml << YAML::EndMap << YAML::EndMap;
  return std::string(yaml.c_str()) + "\n";
}

}  // namespace finray
