#include "finray/io/column_mapping.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <iterator>

#include "finray/io/frame_vocabulary.h"
#include "finray/io/message_text.h"

namespace finray {
namespace {

// Besides the empty cell. printf writes a NaN with its sign; scripts/import has
// the same words.
constexpr std::string_view kNotMeasured[] = {
    "-",   "--",   "---",  "?",       "na",  "n/a",  "#n/a",
    "#nv", "null", "none", "missing", "nan", "+nan", "-nan"};

// Returns the dimension of a rule's target.
Dimension DimensionOf(const ColumnRule& rule) {
  return UnitOfColumn(rule.to).dimension;
}

AdcCounts ReadCounts(const YamlMap& yaml) {
  yaml.AllowOnly({"adc_bits", "range_V", "signed"});
  constexpr int kMostBits = 32;
  AdcCounts counts{};
  counts.bits = yaml.Integer("adc_bits");
  if (counts.bits < 1 || counts.bits > kMostBits) {
    yaml.Fail("adc_bits", "adc_bits: expected 1 to 32");
  }
  const std::vector<double> range = yaml.Numbers("range_V");
  if (range.size() != 2 || !(range[0] < range[1])) {
    yaml.Fail("range_V",
              "range_V: expected [from, to] in V, the first one smaller");
  }
  counts.from_V = range[0];
  counts.to_V = range[1];
  counts.is_signed = yaml.Boolean("signed", false);
  return counts;
}

void ReadUnit(const YamlMap& yaml, ColumnRule* rule) {
  const Dimension dimension = DimensionOf(*rule);
  const auto refuse = [&](const std::string& found) {
    std::vector<std::string> names = UnitNames(dimension);
    if (dimension == Dimension::kNone) {
      yaml.Fail("unit", "unit: column " + ShownText(rule->to) + " has no unit");
    }
    if (dimension == Dimension::kVoltage) {
      names.push_back("counts {adc_bits, range_V}");
    }
    yaml.Fail("unit", "unit: column " + ShownText(rule->to) + " takes one of " +
                          Joined(names) + ", found " + found);
  };
  if (yaml.IsMap("unit")) {
    if (dimension != Dimension::kVoltage) refuse("counts");
    rule->counts = ReadCounts(yaml.Map("unit"));
    return;
  }
  const std::string name = yaml.Text("unit");
  // Short for the format with its unit.
  const bool epoch_ms = name == "epoch_ms";
  if (dimension == Dimension::kTime && rule->format != TimeFormat::kIso8601 &&
      (epoch_ms || name == "epoch_s" || name == "epoch")) {
    rule->format = TimeFormat::kEpoch;
    rule->unit = FindUnit(epoch_ms ? "ms" : "s");
    return;
  }
  rule->unit = FindUnit(name);
  if (!rule->unit || rule->unit->dimension != dimension) {
    refuse(ShownText(name));
  }
  if (rule->format == TimeFormat::kIso8601) {
    yaml.Fail("unit", "unit: a time of iso8601 has none");
  }
}

// Refuses a target that is no column, at the place of `key`.
void CheckTarget(const YamlMap& yaml, const std::string& key,
                 const ColumnRule& rule) {
  if (IsFrameColumn(rule.to) || rule.to == "status") return;
  yaml.Fail(key, "columns: " + ShownText(rule.from) + " is to become " +
                     ShownText(rule.to) + ", which is no known column" +
                     DidYouMeanFrameColumn(rule.to));
}

ColumnRule ReadRule(const std::string& header, const YamlMap& yaml) {
  yaml.AllowOnly({"to", "scale", "offset", "unit", "format"});
  ColumnRule rule;
  rule.from = header;
  rule.to = yaml.Text("to");
  CheckTarget(yaml, "to", rule);
  if (rule.to == "status" && yaml.Keys().size() > 1) {
    yaml.Fail("to", "to: status is a text, which has nothing to convert");
  }
  if (yaml.Has("scale")) {
    rule.scale = yaml.Number("scale", 1);
    if (*rule.scale == 0) yaml.Fail("scale", "scale: expected another than 0");
  }
  rule.offset = yaml.Number("offset", 0);
  if (yaml.Has("format")) {
    const std::string format = yaml.Choice("format", {"iso8601", "epoch"});
    if (DimensionOf(rule) != Dimension::kTime) {
      yaml.Fail("format", "format: it is for time_s, not for " + rule.to);
    }
    rule.format = format == "epoch" ? TimeFormat::kEpoch : TimeFormat::kIso8601;
  }
  if (yaml.Has("unit")) ReadUnit(yaml, &rule);
  return rule;
}

std::vector<ColumnRule> ReadRules(const YamlMap& yaml) {
  std::vector<ColumnRule> rules;
  for (const std::string& key : yaml.Keys()) {
    if (yaml.IsMap(key)) {
      rules.push_back(ReadRule(key, yaml.Map(key)));
      continue;
    }
    // The entry is {theirs: ours}, or the other way round.
    ColumnRule& rule = rules.emplace_back();
    rule.from = key;
    rule.to = yaml.Text(key);
    if (IsFrameColumn(key) && !IsFrameColumn(rule.to)) {
      std::swap(rule.from, rule.to);
    }
    CheckTarget(yaml, key, rule);
  }
  return rules;
}

char ReadDelimiter(const YamlMap& yaml) {
  const std::string text = yaml.RawText("delimiter");
  if (text == "tab" || text == "\t") return '\t';
  if (text == "," || text == ";") return text[0];
  yaml.Fail("delimiter", "delimiter: expected \",\", \";\" or tab, found " +
                             ShownText(text));
}

ColumnMapping ReadKeys(const YamlMap& yaml) {
  ColumnMapping mapping;
  if (yaml.IsMap("columns")) mapping.rules = ReadRules(yaml.Map("columns"));
  if (yaml.Has("delimiter")) mapping.delimiter = ReadDelimiter(yaml);
  if (yaml.Has("decimal")) {
    mapping.decimal = yaml.Choice("decimal", {".", ","})[0];
  }
  if (yaml.Has("header_line")) {
    mapping.header_line = yaml.Integer("header_line");
    if (*mapping.header_line < 1) {
      yaml.Fail("header_line", "header_line: expected a line, from 1 on");
    }
  }
  if (yaml.Has("units_row")) {
    mapping.units_row = yaml.Boolean("units_row");
  }
  if (yaml.Has("not_measured")) {
    mapping.not_measured = yaml.Texts("not_measured");
  }
  return mapping;
}

char Lower(char c) {
  return static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
}

bool IsWord(std::string_view cell, std::string_view word) {
  return std::equal(cell.begin(), cell.end(), word.begin(), word.end(),
                    [](char c, char w) { return Lower(c) == w; });
}

}  // namespace

void ColumnMapping::AddMissing(const ColumnMapping& other) {
  for (const ColumnRule& rule : other.rules) {
    const bool known =
        std::any_of(rules.begin(), rules.end(), [&rule](const auto& mine) {
          return mine.from == rule.from || mine.to == rule.to;
        });
    if (!known) rules.push_back(rule);
  }
  if (!delimiter) delimiter = other.delimiter;
  if (!decimal) decimal = other.decimal;
  if (!header_line) header_line = other.header_line;
  if (!units_row) units_row = other.units_row;
  if (not_measured.empty()) not_measured = other.not_measured;
  if (path.empty()) path = other.path;
}

const std::vector<std::string>& ColumnMappingKeys() {
  static const std::vector<std::string> keys = {"columns",   "delimiter",
                                                "decimal",   "header_line",
                                                "units_row", "not_measured"};
  return keys;
}

ColumnMapping ReadColumnMapping(const YamlMap& yaml) {
  ColumnMapping mapping = ReadKeys(yaml);
  if (!yaml.Has("columns") || yaml.IsMap("columns")) return mapping;
  const std::filesystem::path file = yaml.Text("columns");
  mapping.path =
      (std::filesystem::path(yaml.path()).parent_path() / file).string();
  const YamlMap shared = YamlMap::FromFile(mapping.path);
  std::vector<std::string> keys = ColumnMappingKeys();
  keys.push_back("schema_version");
  shared.AllowOnly(keys);
  if (shared.Has("schema_version") && shared.Integer("schema_version") != 1) {
    shared.Fail("schema_version", "expected 1");
  }
  shared.Map("columns");  // this file names no other one
  mapping.AddMissing(ReadKeys(shared));
  return mapping;
}

bool IsNotMeasured(std::string_view cell) {
  return cell.empty() ||
         std::any_of(std::begin(kNotMeasured), std::end(kNotMeasured),
                     [&](std::string_view word) { return IsWord(cell, word); });
}

}  // namespace finray
