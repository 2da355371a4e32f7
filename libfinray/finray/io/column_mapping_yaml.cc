#include "finray/io/column_mapping_yaml.h"

#include "finray/io/yaml_emitter.h"

namespace finray {
namespace {

void EmitRule(const ColumnRule& rule, YamlEmitter* yaml) {
  *yaml << YAML::Flow << YAML::BeginMap;
  YamlPair(yaml, "to", rule.to);
  if (rule.scale) YamlPair(yaml, "scale", *rule.scale);
  if (rule.offset != 0) YamlPair(yaml, "offset", rule.offset);
  if (rule.unit) YamlPair(yaml, "unit", std::string(rule.unit->name));
  if (const auto& counts = rule.counts) {
    *yaml << YAML::Key << "unit" << YAML::Value << YAML::BeginMap;
    YamlPairs(yaml, "adc_bits", counts->bits, "range_V",
              std::vector<double>{counts->from_V, counts->to_V}, "signed",
              counts->is_signed);
    *yaml << YAML::EndMap;
  }
  if (rule.format != TimeFormat::kNumber) {
    YamlPair(yaml, "format",
             rule.format == TimeFormat::kEpoch ? "epoch" : "iso8601");
  }
  *yaml << YAML::EndMap;
}

}  // namespace

std::string ColumnMappingToYaml(const ColumnMapping& mapping) {
  YamlEmitter yaml;
  yaml.SetStringFormat(YAML::DoubleQuoted);
  yaml << YAML::BeginMap;
  bool any = false;
  const auto pair = [&](const char* key, const auto& value) {
    any = true;
    yaml << YAML::Key << YAML::Auto << key << YAML::Value << value;
  };
  if (!mapping.rules.empty()) {
    any = true;
    yaml << YAML::Key << YAML::Auto << "columns" << YAML::Value
         << YAML::BeginMap;
    for (const ColumnRule& rule : mapping.rules) {
      yaml << YAML::Key << rule.from << YAML::Value;
      EmitRule(rule, &yaml);
    }
    yaml << YAML::EndMap;
  }
  if (mapping.delimiter) {
    pair("delimiter", *mapping.delimiter == '\t'
                          ? std::string("tab")
                          : std::string(1, *mapping.delimiter));
  }
  if (mapping.decimal) pair("decimal", std::string(1, *mapping.decimal));
  if (mapping.header_line) pair("header_line", *mapping.header_line);
  if (mapping.units_row) pair("units_row", *mapping.units_row);
  if (!mapping.not_measured.empty()) {
    yaml << YAML::Flow;
    pair("not_measured", mapping.not_measured);
  }
  yaml << YAML::EndMap;
  return any ? std::string(yaml.c_str()) + "\n" : "";
}

}  // namespace finray
