#include <cmath>

#include "finray/calib/analysis/calibration_comparison.h"
#include "finray/io/sha256.h"
#include "finray/io/yaml_emitter.h"

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
                           const std::vector<ComparisonGate>& gates) {
  YamlEmitter yaml;
  yaml << YAML::BeginMap;
  YamlPair(&yaml, "schema_version", 1);
  bool passed = true;
  for (const ComparisonGate& gate : gates) passed &= gate.passed;
  YamlPair(&yaml, "verdict",
           gates.empty() ? "no_gates"
           : passed      ? "passed"
                         : "failed");
  const std::pair<const char*, const CalibrationFile*> files[] = {{"a", &a},
                                                                  {"b", &b}};
  for (const auto& [key, file] : files) {
    yaml << YAML::Key << key << YAML::Value << YAML::Flow << YAML::BeginMap;
    YamlPair(&yaml, "path", file->path);
    YamlPair(&yaml, "sha256", Sha256OfFile(file->path));
    yaml << YAML::EndMap;
  }
  YamlPair(&yaml, "shared_logs", comparison.shared_logs);
  yaml << YAML::Key << "parameters" << YAML::Value << YAML::BeginSeq;
  for (const Comparison::Parameter& p : comparison.parameters) {
    yaml << YAML::Flow << YAML::BeginMap;
    YamlPair(&yaml, "name", p.name);
    YamlPair(&yaml, "unit", p.unit);
    YamlPair(&yaml, "a", p.a);
    YamlPair(&yaml, "b", p.b);
    YamlPair(&yaml, "difference", p.b - p.a);
    YamlPair(&yaml, "std", p.std);
    YamlPair(&yaml, "difference_over_std", p.sigma());
    yaml << YAML::EndMap;
  }
  yaml << YAML::EndSeq;
  const std::pair<const char*, const std::vector<std::string>&> unmatched[] = {
      {"only_in_a", comparison.only_a},
      {"only_in_b", comparison.only_b},
      {"of_other_logs", comparison.of_other_logs}};
  for (const auto& [key, names] : unmatched) {
    yaml << YAML::Key << key << YAML::Value << YAML::Flow << names;
  }
  yaml << YAML::Key << "all" << YAML::Value << YAML::Flow << YAML::BeginMap;
  YamlPair(&yaml, "chi2", comparison.chi2);
  YamlPair(&yaml, "dof", comparison.dof);
  YamlPair(&yaml, "p_value", comparison.p_value());
  yaml << YAML::EndMap;
  const Comparison::Largest most = comparison.largest();
  yaml << YAML::Key << "predicted" << YAML::Value << YAML::BeginMap;
  YamlPair(&yaml, "points", comparison.grid.size());
  YamlPair(&yaml, "compared_points", most.points);
  YamlPair(&yaml, "lost_points", most.lost);
  if (most.points > 0) {
    YamlPair(&yaml, "force_rms_difference_N", most.force_rms_N);
    YamlPair(&yaml, "force_max_difference_N", most.force_N);
    YamlPair(&yaml, "force_max_difference_over_std", most.force_over_std);
    YamlPair(&yaml, "contact_rms_difference_mm", most.contact_rms_mm);
    YamlPair(&yaml, "contact_max_difference_mm", most.contact_mm);
    YamlPair(&yaml, "contact_max_difference_over_std", most.contact_over_std);
  }
  yaml << YAML::EndMap << YAML::Key << "gates" << YAML::Value << YAML::BeginSeq;
  for (const ComparisonGate& gate : gates) {
    yaml << YAML::Flow << YAML::BeginMap;
    YamlPair(&yaml, "name", gate.name);
    YamlPair(&yaml, "bound", gate.bound);
    YamlPair(&yaml, "value", gate.value);
    YamlPair(&yaml, "passed", gate.passed);
    yaml << YAML::EndMap;
  }
  yaml << YAML::EndSeq;
  YamlPair(&yaml, "version", FINRAY_VERSION);
  yaml << YAML::EndMap;
  return std::string(yaml.c_str()) + "\n";
}

}  // namespace finray
