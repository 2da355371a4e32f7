#include "finray/calib/plan.h"

#include <filesystem>
#include <vector>

namespace finray {
namespace {

struct FamilyKey {
  const char* key;
  const char* prior_key;
};
// In the order of ParameterFamily.
constexpr FamilyKey kFamilyKeys[kParameterFamilies] = {
    {"front_stiffness", "prior_std_percent"},
    {"back_stiffness", "prior_std_percent"},
    {"gauge_gain", "prior_std_percent"},
    {"gauge_offset", "prior_std_V"},
    {"rib_length", "prior_std_mm"},
    {"object_origin", "prior_std_mm"},
};
// Parameters that a plan may name but that are not part of the model yet.
constexpr FamilyKey kFixedOnlyKeys[] = {
    {"force_scale", "prior_std_percent"},
    {"force_offset", "prior_std_N"},
    {"temperature_coefficient", "prior_std_percent_per_K"},
    {"gauge_drift", "prior_std_V_per_h"},
};

void ReadParameters(const YamlMap& yaml, Plan* plan) {
  std::vector<std::string> known;
  for (const FamilyKey& family : kFamilyKeys) known.push_back(family.key);
  for (const FamilyKey& family : kFixedOnlyKeys) known.push_back(family.key);
  yaml.AllowOnly(known);
  for (int i = 0; i < kParameterFamilies; ++i) {
    const auto [key, prior_key] = kFamilyKeys[i];
    if (!yaml.Has(key)) continue;
    const YamlMap map = yaml.Map(key);
    map.AllowOnly({"fixed", prior_key});
    FamilyPlan& family = plan->families[i];
    family.free = !map.Boolean("fixed", false);
    if (map.Has(prior_key)) {
      if (!family.free) map.Fail(prior_key, "a fixed parameter has no prior");
      family.prior_std = map.PositiveNumber(prior_key);
    }
  }
  for (const auto [key, prior_key] : kFixedOnlyKeys) {
    if (!yaml.Has(key)) continue;
    const YamlMap map = yaml.Map(key);
    map.AllowOnly({"fixed", prior_key});
    if (!map.Boolean("fixed", false)) {
      yaml.Fail(key, std::string(key) +
                         " cannot be estimated; write {fixed: true} or leave "
                         "it out");
    }
  }
}

Scene ReadPlanScene(const YamlMap& yaml) {
  if (!yaml.Has("scene")) return {};
  if (yaml.IsMap("scene")) return ReadScene(yaml.Map("scene"));
  // Relative to the plan, so that a folder of both can be moved.
  const std::filesystem::path scene = yaml.Text("scene");
  return ReadScene(
      (std::filesystem::path(yaml.path()).parent_path() / scene).string());
}

}  // namespace

Plan ReadPlan(const std::string& path) {
  const YamlMap yaml = YamlMap::FromFile(path);
  yaml.AllowOnly({"schema_version", "scene", "parameters", "measurements",
                  "robust_loss", "holdout", "columns"});
  if (yaml.Integer("schema_version") != 1) {
    yaml.Fail("schema_version", "expected 1");
  }
  Plan plan;
  plan.scene = ReadPlanScene(yaml);
  RefuseBackContacts(plan.scene);
  if (plan.scene.object_std_mm || plan.scene.smoothing) {
    yaml.Fail("scene",
              "a plan's scene has no measurements and no smoothing: the plan "
              "has measurements of its own");
  }
  if (plan.scene.contacts.value_or(1) > 1) {
    yaml.Fail("scene", "calibration takes frames with one contact or none");
  }
  if (plan.scene.object &&
      (!plan.scene.circle_radius_mm() || plan.scene.object->spring)) {
    yaml.Fail("scene",
              "calibration takes circles held rigidly as objects, no other "
              "shape and no spring");
  }
  ReadParameters(yaml.Map("parameters"), &plan);
  if (yaml.Has("measurements")) {
    const YamlMap map = yaml.Map("measurements");
    map.AllowOnly(
        {"force_std_N", "gauge_std_V", "object_std_mm", "contact_std_mm"});
    plan.force_std_N = map.PositiveNumber("force_std_N", plan.force_std_N);
    if (map.Has("gauge_std_V")) {
      plan.gauge_std_V = map.PositiveNumber("gauge_std_V");
    }
    plan.object_std_mm =
        map.PositiveNumber("object_std_mm", plan.object_std_mm);
    plan.contact_std_mm =
        map.PositiveNumber("contact_std_mm", plan.contact_std_mm);
  }
  if (yaml.Has("robust_loss")) {
    const YamlMap map = yaml.Map("robust_loss");
    map.AllowOnly({"type", "scale"});
    const std::string type = map.Choice("type", {"none", "huber", "cauchy"});
    plan.loss = type == "none"    ? RobustLoss::kNone
                : type == "huber" ? RobustLoss::kHuber
                                  : RobustLoss::kCauchy;
    plan.loss_scale = map.PositiveNumber("scale", plan.loss_scale);
  }
  if (yaml.Has("holdout")) {
    const YamlMap map = yaml.Map("holdout");
    map.AllowOnly({"by", "fraction"});
    plan.holdout_by = map.Choice("by", {"log", "block"}) == "log"
                          ? HoldoutBy::kLog
                          : HoldoutBy::kBlock;
    plan.holdout_fraction = map.PositiveNumber("fraction", 0.2);
    if (plan.holdout_fraction >= 1) {
      map.Fail("fraction", "expected a fraction between 0 and 1");
    }
  }
  plan.columns = ReadColumns(yaml);
  for (const auto& rename : plan.scene.columns) plan.columns.insert(rename);
  return plan;
}

}  // namespace finray
