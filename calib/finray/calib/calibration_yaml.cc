#include <ceres/version.h>
#include <yaml-cpp/yaml.h>

#include <cmath>

#include "finray/calib/calibration_checks_yaml.h"
#include "finray/calib/calibration_result.h"
#include "finray/calib/yaml_number.h"
#include "finray/io/atomic_file.h"
#include "finray/io/sha256.h"

namespace finray {
namespace {

template <class T>
void Pair(YAML::Emitter* yaml, const char* key, const T& value) {
  *yaml << YAML::Key << key << YAML::Value << value;
}
void Number(YAML::Emitter* yaml, const char* key, double value) {
  Pair(yaml, key, YamlNumber(value));
}

void EmitParameters(CalibrationProblem& problem, const Identifiability& found,
                    YAML::Emitter* yaml) {
  *yaml << YAML::Key << "parameters" << YAML::Value << YAML::BeginSeq;
  const CalibrationParameters& parameters = problem.parameters();
  std::size_t free = 0;
  for (std::size_t i = 0; i < parameters.all().size(); ++i) {
    const CalibrationParameter& p = parameters.all()[i];
    const bool is_free = free < parameters.free().size() &&
                         parameters.free()[free] == static_cast<int>(i);
    *yaml << YAML::Flow << YAML::BeginMap;
    Pair(yaml, "name", p.name);
    Pair(yaml, "unit", p.unit);
    Number(yaml, "initial", p.Value(p.initial));
    Number(yaml, "value", p.Value(*p.variable));
    Number(yaml, "std",
           is_free ? p.ValueStd(*p.variable, found.std[free]) : 0.0);
    Number(yaml, "prior_std",
           p.prior_std ? p.ValueStd(p.initial, *p.prior_std) : std::nan(""));
    Pair(yaml, "status",
         ParameterStatusName(is_free ? found.status[free]
                                     : ParameterStatus::kFixed));
    *yaml << YAML::EndMap;
    free += is_free;
  }
  *yaml << YAML::EndSeq;
}

void EmitWeakDirections(CalibrationProblem& problem,
                        const Identifiability& found, YAML::Emitter* yaml) {
  *yaml << YAML::Key << "weak_directions" << YAML::Value << YAML::BeginSeq;
  for (const WeakDirection& weak : found.weak) {
    *yaml << YAML::BeginMap;
    Pair(yaml, "words", weak.words);
    Pair(yaml, "how_far", weak.how_far);
    Pair(yaml, "remedy", weak.remedy);
    Number(yaml, "std_over_prior", weak.std_over_prior);
    *yaml << YAML::Key << "components" << YAML::Value << YAML::Flow
          << YAML::BeginMap;
    for (const auto& component : weak.components) {
      Number(yaml, problem.parameters().all()[component.parameter].name.c_str(),
             component.share);
    }
    *yaml << YAML::EndMap << YAML::EndMap;
  }
  *yaml << YAML::EndSeq;
}

void EmitCorrelations(CalibrationProblem& problem, const Identifiability& found,
                      YAML::Emitter* yaml) {
  const CalibrationParameters& parameters = problem.parameters();
  *yaml << YAML::Key << "correlations" << YAML::Value << YAML::BeginMap;
  *yaml << YAML::Key << "names" << YAML::Value << YAML::Flow << YAML::BeginSeq;
  for (const int i : parameters.free()) *yaml << parameters.all()[i].name;
  *yaml << YAML::EndSeq << YAML::Key << "matrix" << YAML::Value
        << YAML::BeginSeq;
  for (int i = 0; i < found.correlation.rows(); ++i) {
    *yaml << YAML::Flow << YAML::BeginSeq;
    for (int j = 0; j < found.correlation.cols(); ++j) {
      *yaml << YamlNumber(std::round(found.correlation(i, j) * 1e6) / 1e6);
    }
    *yaml << YAML::EndSeq;
  }
  *yaml << YAML::EndSeq << YAML::EndMap;
}

void EmitNoise(const Identifiability& found, YAML::Emitter* yaml) {
  *yaml << YAML::Key << "noise" << YAML::Value << YAML::BeginMap;
  for (int i = 0; i < kResidualFamilies; ++i) {
    const Identifiability::Noise& noise = found.noise[i];
    if (noise.residuals == 0) continue;
    *yaml << YAML::Key << ResidualFamilyName(static_cast<ResidualFamily>(i))
          << YAML::Value << YAML::Flow << YAML::BeginMap;
    Pair(yaml, "residuals", noise.residuals);
    Number(yaml, "dof", noise.dof);
    Number(yaml, "chi2", noise.chi2);
    // Without spare measurements the ratio would be noise over nothing.
    Number(yaml, "chi2_per_dof",
           noise.dof > 0.5 ? noise.chi2 / noise.dof : std::nan(""));
    *yaml << YAML::EndMap;
  }
  *yaml << YAML::EndMap;
}

void EmitBench(const std::vector<BenchLinearity>& bench, YAML::Emitter* yaml) {
  if (bench.empty()) return;
  *yaml << YAML::Key << "bench" << YAML::Value << YAML::BeginSeq;
  for (const BenchLinearity& of_gauge : bench) {
    *yaml << YAML::BeginMap;
    Pair(yaml, "gauge", of_gauge.gauge + 1);
    Pair(yaml, "readings", of_gauge.readings);
    Pair(yaml, "linear", of_gauge.IsLinear());
    Number(yaml, "largest_angle_rad", of_gauge.largest_angle_rad);
    Number(yaml, "quadratic_V_per_rad2", of_gauge.quadratic_V_per_rad2);
    Number(yaml, "quadratic_std", of_gauge.quadratic_std);
    Number(yaml, "quadratic_p_value", of_gauge.quadratic_p_value);
    Number(yaml, "lack_of_fit_F", of_gauge.lack_of_fit_F);
    Number(yaml, "lack_of_fit_p_value", of_gauge.lack_of_fit_p_value);
    *yaml << YAML::EndMap;
  }
  *yaml << YAML::EndSeq;
}

void EmitForceError(const ForceCheck::Error& error, YAML::Emitter* yaml) {
  *yaml << YAML::Flow << YAML::BeginMap;
  Pair(yaml, "frames", error.frames);
  if (error.frames > 0) {
    if (error.frames_before > 0) {
      Number(yaml, "force_rms_error_before_N", error.before_rms_N);
      Pair(yaml, "frames_before", error.frames_before);
    }
    Number(yaml, "force_rms_error_after_N", error.after_rms_N);
    Number(yaml, "force_max_error_after_N", error.after_max_N);
    Number(yaml, "force_mean_N", error.reference_mean_N);
  }
  *yaml << YAML::EndMap;
}

void EmitInputs(const CalibrationInputs& inputs, YAML::Emitter* yaml) {
  const auto file = [yaml](const std::string& path) {
    *yaml << YAML::Flow << YAML::BeginMap;
    Pair(yaml, "path", path);
    Pair(yaml, "sha256", Sha256OfFile(path));
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
                YAML::Emitter* yaml) {
  constexpr const char* kLosses[] = {"none", "huber", "cauchy"};
  *yaml << YAML::Key << "config" << YAML::Value << YAML::BeginMap;
  Pair(yaml, "command", inputs.command);
  Pair(yaml, "scheme", inputs.scheme);
  Pair(yaml, "resolution", inputs.resolution);
  Pair(yaml, "contacts",
       plan.scene.contacts ? std::to_string(*plan.scene.contacts) : "auto");
  if (!plan.scene.contact_beams.empty()) {
    Pair(yaml, "contact_beams", YAML::Load(ContactBeamsToYaml(plan.scene)));
  }
  Number(yaml, "friction_coefficient", plan.scene.friction_coefficient);
  if (plan.scene.circle_radius_mm()) {
    Number(yaml, "circle_radius_mm", *plan.scene.circle_radius_mm());
  }
  Number(yaml, "force_std_N", plan.force_std_N);
  if (plan.gauge_std_V) Number(yaml, "gauge_std_V", *plan.gauge_std_V);
  Number(yaml, "object_std_mm", plan.object_std_mm);
  Number(yaml, "contact_std_mm", plan.contact_std_mm);
  if (plan.pin_std_mm) Number(yaml, "pin_std_mm", *plan.pin_std_mm);
  if (plan.tip_std_mm) Number(yaml, "tip_std_mm", *plan.tip_std_mm);
  if (plan.family(ParameterFamily::kTemperatureCoefficient).free) {
    Number(yaml, "reference_C", plan.reference_temperature_C);
  }
  if (plan.gauge_walk) {
    Number(yaml, "walk_std_V_per_sqrt_h", plan.gauge_walk->std_V_per_sqrt_h);
    Number(yaml, "knot_every_s", plan.gauge_walk->knot_every_s);
  }
  Pair(yaml, "robust_loss", kLosses[static_cast<int>(plan.loss)]);
  Number(yaml, "robust_scale", plan.loss_scale);
  *yaml << YAML::EndMap;
}

}  // namespace

std::string CalibrationYaml(CalibrationProblem& problem,
                            const CalibrationResult& result,
                            const CalibrationInputs& inputs) {
  YAML::Emitter yaml;
  yaml << YAML::BeginMap;
  Pair(&yaml, "schema_version", 1);
  Pair(&yaml, "finger", problem.finger().name);
  Pair(&yaml, "verdict", result.Verdict());
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
    Pair(&yaml, "code", warning.code);
    Pair(&yaml, "text", warning.text);
    Pair(&yaml, "remedy", warning.remedy);
    yaml << YAML::EndMap;
  }
  yaml << YAML::EndSeq;
  yaml << YAML::Key << "solver" << YAML::Value << YAML::Flow << YAML::BeginMap;
  Pair(&yaml, "converged", result.solution.solve.converged);
  Pair(&yaml, "iterations", result.solution.solve.iterations);
  Number(&yaml, "initial_cost", result.solution.solve.initial_cost);
  Number(&yaml, "final_cost", result.solution.solve.final_cost);
  yaml << YAML::EndMap;
  EmitInputs(inputs, &yaml);
  EmitConfig(problem.plan(), inputs, &yaml);
  yaml << YAML::Key << "versions" << YAML::Value << YAML::Flow
       << YAML::BeginMap;
  Pair(&yaml, "finray", FINRAY_VERSION);
  Pair(&yaml, "ceres", CERES_VERSION_STRING);
  yaml << YAML::EndMap << YAML::EndMap;
  return std::string(yaml.c_str()) + "\n";
}

}  // namespace finray
