#include "finray/perception/compliance_files.h"

#include <algorithm>
#include <cmath>

#include "finray/finger/geometry.h"
#include "finray/io/yaml_emitter.h"
#include "finray/perception/inputs_yaml.h"

namespace finray {
namespace {

void EmitTrial(const ComplianceTrial& trial, YamlEmitter* yaml) {
  const StiffnessFit& fit = trial.fit;
  *yaml << YAML::BeginMap;
  YamlPairs(yaml, "object", trial.object, "trial", trial.name, "rows",
            trial.rows, "points", fit.points, "standing", fit.standing,
            "left_out", fit.left_out.size(), "direction_deg",
            trial.direction.angle_rad / kDegree, "direction_std_deg",
            trial.direction.std_rad / kDegree, "stiffness_N_per_mm",
            trial.stiffness.N_per_mm, "std_N_per_mm", trial.stiffness.std,
            "friction_N", fit.friction_N(), "friction_std_N",
            fit.friction_std_N());
  *yaml << YAML::Key << "law" << YAML::Value << YAML::Flow << YAML::BeginSeq;
  for (int m = 0; m <= fit.law.degree; ++m) *yaml << fit.coefficients[m];
  *yaml << YAML::EndSeq;
  YamlPairs(yaml, "chi2", fit.chi2, "dof", fit.dof);
  *yaml << YAML::EndMap;
}

}  // namespace

FrameTable PointTable(const Compliance& found) {
  std::size_t count = 0, next = 0;
  for (const ComplianceTrial& trial : found.trials) {
    count += trial.points.size();
  }
  FrameTable table(count);
  for (const ComplianceTrial& trial : found.trials) {
    for (const ForcePoint& point : trial.points) {
      const auto set = [&](const char* name, double value) {
        table.MutableNumbers(name)[next] = value;
      };
      table.MutableText("object")[next] = trial.object;
      table.MutableText("trial")[next] = trial.name;
      set("row", static_cast<double>(point.row + 1));
      set("displacement_mm", point.displacement_mm);
      set("displacement_std_mm", std::sqrt(point.covariance(0, 0)));
      set("force_N", point.force_N);
      set("force_std_N", std::sqrt(point.covariance(1, 1)));
      set("direction", point.direction);
      set("slides", point.slides ? 1 : 0);
      const std::vector<std::size_t>& rows = trial.fit.left_out;
      set("left_out",
          std::count(rows.begin(), rows.end(), point.row) > 0 ? 1 : 0);
      ++next;
    }
  }
  return table;
}

FrameTable StiffnessTable(const Compliance& found) {
  FrameTable table(found.objects.size());
  for (std::size_t i = 0; i < found.objects.size(); ++i) {
    const ObjectStiffness& object = found.objects[i];
    const auto set = [&](const char* name, double value) {
      table.MutableNumbers(name)[i] = value;
    };
    table.MutableText("object")[i] = object.name;
    set("trials", static_cast<double>(object.trials.size()));
    set("stiffness_N_per_mm", object.mean.N_per_mm);
    set("std_N_per_mm", object.mean.std);
    set("calibration_std_N_per_mm", object.calibration_std);
    set("probability_stiffer_than_next", i < found.pair_confidence.size()
                                             ? found.pair_confidence[i]
                                             : std::nan(""));
  }
  return table;
}

FrameTable LawTable(const Compliance& found) {
  constexpr std::size_t kSteps = 40;
  FrameTable table(found.trials.size() * (kSteps + 1));
  std::size_t next = 0;
  for (const ComplianceTrial& trial : found.trials) {
    const StiffnessFit& fit = trial.fit;
    for (std::size_t k = 0; k <= kSteps; ++k, ++next) {
      const double u = fit.least_mm + (fit.largest_mm - fit.least_mm) *
                                          static_cast<double>(k) / kSteps;
      table.MutableText("object")[next] = trial.object;
      table.MutableText("trial")[next] = trial.name;
      table.MutableNumbers("displacement_mm")[next] = u;
      table.MutableNumbers("force_N")[next] = fit.ForceAt(u);
      table.MutableNumbers("friction_N")[next] = fit.friction_N();
    }
  }
  return table;
}

std::string ComplianceYaml(const Compliance& found,
                           const std::vector<std::string>& inputs) {
  YamlEmitter yaml;
  yaml << YAML::BeginMap << YAML::Key << "compared_between_N" << YAML::Value
       << YAML::Flow << std::vector<double>{found.from_N, found.to_N};
  YamlPair(&yaml, "order_confidence", found.order_confidence);
  yaml << YAML::Key << "objects" << YAML::Value << YAML::BeginSeq;
  for (std::size_t i = 0; i < found.objects.size(); ++i) {
    const ObjectStiffness& object = found.objects[i];
    yaml << YAML::BeginMap;
    YamlPairs(&yaml, "object", object.name, "trials", object.trials.size(),
              "stiffness_N_per_mm", object.mean.N_per_mm, "std_N_per_mm",
              object.mean.std, "calibration_std_N_per_mm",
              object.calibration_std);
    if (i < found.pair_confidence.size()) {
      YamlPair(&yaml, "probability_stiffer_than_next",
               found.pair_confidence[i]);
    }
    yaml << YAML::EndMap;
  }
  yaml << YAML::EndSeq << YAML::Key << "trials" << YAML::Value
       << YAML::BeginSeq;
  for (const ComplianceTrial& trial : found.trials) EmitTrial(trial, &yaml);
  yaml << YAML::EndSeq;
  EmitInputs(inputs, &yaml);
  yaml << YAML::EndMap;
  return std::string(yaml.c_str()) + "\n";
}

}  // namespace finray
