#include "finray/calib/analysis/error_table.h"

#include <algorithm>
#include <cmath>

#include "finray/io/nan.h"
#include "finray/io/yaml_emitter.h"

namespace finray {
namespace {

constexpr double k95 = 1.959964;

double Percent(std::size_t part, std::size_t of) {
  return of == 0 ? kNaN
                 : 100 * static_cast<double>(part) / static_cast<double>(of);
}

void EmitStatistics(const ErrorStatistics& errors, const char* quantity,
                    const char* unit, bool touching, YamlEmitter* yaml) {
  if (errors.frames + errors.judged == 0) return;
  const std::string name(quantity), suffix = std::string("_") + unit;
  YamlPairs(yaml, name + "_frames", errors.frames, name + "_rms" + suffix,
            errors.rms(), name + "_bias" + suffix, errors.bias(),
            name + "_max" + suffix, errors.largest);
  // A free frame has no percentage: it would be a percentage of noise.
  if (touching && name == "force") {
    YamlPair(yaml, name + "_rms_percent", errors.percent());
  }
  if (errors.judged == 0) return;
  YamlPair(yaml, name + "_coverage_68_percent", errors.coverage_68_percent());
  YamlPair(yaml, name + "_coverage_95_percent", errors.coverage_95_percent());
  if (errors.scored > 0) YamlPair(yaml, name + "_rms_z", errors.rms_z());
}

// Emits the keys of a row into a mapping that has begun.
void EmitRow(const ErrorRow& row, bool touching, YamlEmitter* yaml) {
  YamlPair(yaml, "frames", row.frames);
  YamlPair(yaml, "usable", row.usable);
  if (row.missed > 0) YamlPair(yaml, "missed", row.missed);
  if (row.untrue > 0) YamlPair(yaml, "untrue", row.untrue);
  EmitStatistics(row.force_N, "force", "N", touching, yaml);
  EmitStatistics(row.contact_mm, "contact", "mm", touching, yaml);
}

}  // namespace

void ErrorStatistics::Add(double error, double reference, double std) {
  if (std::isnan(error)) return;
  ++frames;
  squares += error * error;
  sum += error;
  largest = std::max(largest, std::abs(error));
  reference_squares += reference * reference;
  reference_sum += reference;
  if (!std::isfinite(std)) return;
  ++judged;
  ++scored;
  z_squares += error * error / (std * std);
  within_68 += std::abs(error) <= std;
  within_95 += std::abs(error) <= k95 * std;
}

void ErrorStatistics::Miss(double reference) {
  judged += !std::isnan(reference);
}

double ErrorStatistics::rms() const {
  return frames == 0 ? kNaN : std::sqrt(squares / static_cast<double>(frames));
}
double ErrorStatistics::bias() const {
  return frames == 0 ? kNaN : sum / static_cast<double>(frames);
}
double ErrorStatistics::reference_mean() const {
  return frames == 0 ? kNaN : reference_sum / static_cast<double>(frames);
}
double ErrorStatistics::percent() const {
  return frames == 0 ? kNaN : 100 * std::sqrt(squares / reference_squares);
}
double ErrorStatistics::rms_z() const {
  return scored == 0 ? kNaN
                     : std::sqrt(z_squares / static_cast<double>(scored));
}
double ErrorStatistics::coverage_68_percent() const {
  return Percent(within_68, judged);
}
double ErrorStatistics::coverage_95_percent() const {
  return Percent(within_95, judged);
}

double ErrorRow::usable_percent() const { return Percent(usable, frames); }

void ErrorRow::Add(const FrameReference& reference,
                   const FrameEstimate& estimate, double friction) {
  ++frames;
  const bool touches = estimate.contacts > 0;
  if (estimate.status != FrameStatus::kOk &&
      estimate.status != FrameStatus::kNoContact) {
    return;
  }
  ++usable;
  const bool missing = reference.contact && !touches && !reference.undecided;
  missed += missing;
  untrue += !reference.contact && touches && !reference.undecided;
  // If the estimate has two contacts, neither is the reference's, and the std
  // of the sum of their forces is not known.
  const bool one = estimate.contacts == 1;
  const ContactEstimate& found = estimate.contact[0];
  force_N.Add(EstimatedForce(estimate, friction) - reference.force_N,
              reference.force_N,
              one ? std::hypot(EstimatedForceStd(estimate, friction),
                               reference.force_std_N)
                  : kNaN);
  if (missing) {
    force_N.Miss(reference.force_N);
    contact_mm.Miss(reference.contact_mm);
  }
  if (!one) return;
  contact_mm.Add(found.arc_mm - reference.contact_mm, reference.contact_mm,
                 std::hypot(found.arc_std_mm, reference.contact_std_mm));
}

int ErrorTable::RegionOf(double arc_mm) const {
  if (std::isnan(arc_mm)) return -1;
  return std::clamp(static_cast<int>(kRegions * arc_mm / front_length_mm), 0,
                    kRegions - 1);
}

void ErrorTable::Add(const FrameReference& reference,
                     const FrameEstimate& estimate, double place_mm,
                     double friction) {
  if (!reference.contact) {
    free.Add(reference, estimate, friction);
    return;
  }
  contact.Add(reference, estimate, friction);
  const int region = RegionOf(place_mm);
  if (region >= 0) regions[region].Add(reference, estimate, friction);
}

void EmitErrorTable(const char* key, const ErrorTable& table,
                    YamlEmitter* yaml) {
  const auto row = [&](const char* name, const ErrorRow& errors) {
    if (errors.frames == 0) return;
    *yaml << YAML::Key << name << YAML::Value << YAML::Flow << YAML::BeginMap;
    EmitRow(errors, &errors != &table.free, yaml);
    *yaml << YAML::EndMap;
  };
  *yaml << YAML::Key << key << YAML::Value << YAML::BeginMap;
  row("contact", table.contact);
  row("free", table.free);
  *yaml << YAML::Key << "regions" << YAML::Value << YAML::BeginSeq;
  for (int i = 0; i < ErrorTable::kRegions; ++i) {
    if (table.regions[i].frames == 0) continue;
    *yaml << YAML::Flow << YAML::BeginMap;
    YamlPair(yaml, "from_mm", i == 0 ? 0 : table.region_end_mm(i - 1));
    YamlPair(yaml, "to_mm", table.region_end_mm(i));
    EmitRow(table.regions[i], true, yaml);
    *yaml << YAML::EndMap;
  }
  *yaml << YAML::EndSeq << YAML::EndMap;
}

}  // namespace finray
