#include <cmath>

#include "finray/calib/analysis/calibration_comparison.h"
#include "finray/calib/report/yaml_rows.h"
#include "finray/io/versions.h"

namespace finray {

FrameTable ComparisonGrid(const Comparison& comparison) {
  FrameTable table(comparison.grid.size());
  for (std::size_t i = 0; i < comparison.grid.size(); ++i) {
    const Comparison::Point& point = comparison.grid[i];
    const auto set = [&](const char* name, double value) {
      table.MutableNumbers(name)[i] = value;
    };
    set("contact_1_mm", point.contact_mm);
    set("normal_1_N", point.normal_N);
    set("force_difference_N", point.force_difference_N);
    set("force_difference_std_N", point.force_std_N);
    set("force_difference_over_std",
        point.force_difference_N / point.force_std_N);
    set("contact_difference_mm", point.contact_difference_mm);
    set("contact_difference_std_mm", point.contact_std_mm);
    set("contact_difference_over_std",
        point.contact_difference_mm / point.contact_std_mm);
  }
  return table;
}

std::string ComparisonYaml(const Comparison& comparison,
                           const CalibrationFile& a, const CalibrationFile& b,
                           const std::vector<Gate>& gates) {
  YamlEmitter yaml;
  yaml << YAML::BeginMap;
  YamlPair(&yaml, "schema_version", 1);
  EmitVerdict(&yaml, gates);
  EmitFile(&yaml, "a", a.path);
  EmitFile(&yaml, "b", b.path);
  YamlPair(&yaml, "shared_logs", comparison.shared_logs);
  EmitSeq(&yaml, "parameters", comparison.parameters, [&](const auto& p) {
    YamlLine(&yaml, "name", p.name, "unit", p.unit, "a", p.a, "b", p.b,
             "difference", p.b - p.a, "std", p.std, "difference_over_std",
             p.sigma());
  });
  const std::pair<const char*, const std::vector<std::string>&> unmatched[] = {
      {"only_in_a", comparison.only_a},
      {"only_in_b", comparison.only_b},
      {"of_other_logs", comparison.of_other_logs}};
  for (const auto& [key, names] : unmatched) {
    yaml << YAML::Key << key << YAML::Value << YAML::Flow << names;
  }
  EmitLine(&yaml, "all", "chi2", comparison.chi2, "dof", comparison.dof,
           "p_value", comparison.p_value());
  const Comparison::Largest most = comparison.largest();
  BeginMap(&yaml, "predicted");
  YamlPairs(&yaml, "points", comparison.grid.size(), "compared_points",
            most.points, "lost_points", most.lost);
  if (most.points > 0) {
    YamlPairs(&yaml, "force_rms_difference_N", most.force_rms_N,
              "force_max_difference_N", most.force_N,
              "force_max_difference_over_std", most.force_over_std,
              "contact_rms_difference_mm", most.contact_rms_mm,
              "contact_max_difference_mm", most.contact_mm,
              "contact_max_difference_over_std", most.contact_over_std);
  }
  yaml << YAML::EndMap;
  EmitGates(&yaml, gates);
  YamlPair(&yaml, "version", FINRAY_VERSION);
  yaml << YAML::EndMap;
  return std::string(yaml.c_str()) + "\n";
}

}  // namespace finray
