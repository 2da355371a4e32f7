#include "finray/calib/problem/plan.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <utility>
#include <vector>

#include "finray/finger/geometry.h"
#include "finray/io/number_text.h"

namespace finray {
namespace {

struct FamilyKey {
  const char* key;
  const char* prior_key;
  const char* own_keys[2] = {};  // those beside `fixed` and its prior
};
constexpr char kWalk[] = "walk_std_V_per_sqrt_h", kKnots[] = "knot_every_s",
               kCount[] = "count";
// The keys stand in the order of ParameterFamily.
constexpr FamilyKey kFamilyKeys[kParameterFamilies] = {
    {"front_stiffness", "prior_std_percent"},
    {"back_stiffness", "prior_std_percent"},
    {"gauge_gain", "prior_std_percent"},
    {"gauge_offset", "prior_std_V", {"per_log"}},
    {"rib_length", "prior_std_mm"},
    {"gauge_curvature", "prior_std_per_rad"},
    {"gauge_start", "prior_std_mm"},
    {"gauge_length", "prior_std_mm"},
    {"gauge_creep_share", "prior_std"},
    {"gauge_creep_time", "prior_std_percent"},
    {"gauge_flat_share", "prior_std"},
    {"gauge_flat_width", "prior_std_percent"},
    {"gauge_hysteresis", "prior_std_rad"},
    {"hinge_stiffness", "prior_std_N_mm_per_rad"},
    {"rib_bending_stiffness", "prior_std_percent"},
    {"stiffness_pieces", "prior_std_percent", {kCount}},  // front
    {"stiffness_pieces", "prior_std_percent", {kCount}},  // back
    {"hinge_place", "prior_std_mm"},                      // front
    {"hinge_place", "prior_std_mm"},                      // back
    {"clamp_compliance", "prior_std_rad_per_N_mm"},       // front
    {"clamp_compliance", "prior_std_rad_per_N_mm"},       // back
    {"back_angle", "prior_std_deg"},
    {"surface_offset", "prior_std_mm"},
    {"friction", "prior_std"},
    {"object_origin", "prior_std_mm", {"per_log"}},
    {"object_rotation", "prior_std_deg", {"per_log"}},
    {"object_scale", "prior_std_percent"},
    {"object_radius", "prior_std_mm"},
    {"force_scale", "prior_std_percent"},
    {"force_offset", "prior_std_N"},
    {"force_time_offset", "prior_std_s"},
    {"force_tilt", "prior_std_deg"},
    {"force_weight", "prior_std_N"},
    {"temperature_coefficient", "prior_std_V_per_C", {"reference_C"}},
    {"gauge_drift", "prior_std_V_per_h", {kWalk, kKnots}},
    {"camera_origin", "prior_std_mm"},
};

void ReadWalk(const YamlMap& map, Plan* plan) {
  if (!map.Has(kWalk) && !map.Has(kKnots)) return;
  if (plan->family(ParameterFamily::kGaugeDrift).prior_std) {
    map.Fail(kWalk,
             "a drift is either at a rate (prior_std_V_per_h) or a walk "
             "(walk_std_V_per_sqrt_h, knot_every_s)");
  }
  plan->gauge_walk = {map.PositiveNumber(kWalk), map.PositiveNumber(kKnots)};
}

void ReadFamily(const YamlMap& yaml, int index, Plan* plan) {
  const FamilyKey& names = kFamilyKeys[index];
  const auto family = static_cast<ParameterFamily>(index);
  const YamlMap map = yaml.Map(names.key);
  std::vector<std::string> allowed = {"fixed", names.prior_key};
  for (const char* key : names.own_keys) {
    if (key != nullptr) allowed.push_back(key);
  }
  map.AllowOnly(allowed);
  FamilyPlan& read = plan->families[index];
  read.free = !map.Boolean("fixed", false);
  if (!read.free) {
    for (const std::string& key : map.Keys()) {
      if (key != "fixed") map.Fail(key, "a fixed parameter has no " + key);
    }
    return;
  }
  if (map.Has(names.prior_key)) {
    read.prior_std = map.PositiveNumber(names.prior_key);
  }
  read.per_log = map.Boolean("per_log", false);
  if (family == ParameterFamily::kTemperatureCoefficient) {
    plan->reference_temperature_C =
        map.Number("reference_C", plan->reference_temperature_C);
  }
  if (family == ParameterFamily::kGaugeDrift) ReadWalk(map, plan);
  if (family == ParameterFamily::kFrontPiece && map.Has(kCount)) {
    plan->piece_count = map.Integer(kCount, plan->piece_count);
    constexpr int kMostPieces = 20;
    if (plan->piece_count < 2 || plan->piece_count > kMostPieces) {
      map.Fail(kCount, "count: expected 2 to 20 pieces");
    }
  }
}

void ReadParameters(const YamlMap& yaml, Plan* plan) {
  std::vector<std::string> known;
  for (const FamilyKey& family : kFamilyKeys) known.push_back(family.key);
  yaml.AllowOnly(known);
  for (int i = 0; i < kParameterFamilies; ++i) {
    if (yaml.Has(kFamilyKeys[i].key)) ReadFamily(yaml, i, plan);
  }
}

Scene ReadPlanScene(const YamlMap& yaml) {
  if (!yaml.Has("scene")) return {};
  if (yaml.IsMap("scene")) return ReadScene(yaml.Map("scene"));
  // The path counts from the folder of the plan, so that a folder with both
  // files can be moved.
  const std::filesystem::path scene = yaml.Text("scene");
  return ReadScene(
      (std::filesystem::path(yaml.path()).parent_path() / scene).string());
}

}  // namespace

ParameterFamily FrontFamilyOf(ParameterFamily family) {
  switch (family) {
    case ParameterFamily::kBackPiece:
      return ParameterFamily::kFrontPiece;
    case ParameterFamily::kBackHinge:
      return ParameterFamily::kFrontHinge;
    case ParameterFamily::kBackClamp:
      return ParameterFamily::kFrontClamp;
    default:
      return family;
  }
}

const char* FamilyKeyOf(ParameterFamily family) {
  return kFamilyKeys[static_cast<int>(family)].key;
}

const char* PriorKeyOf(ParameterFamily family) {
  return kFamilyKeys[static_cast<int>(family)].prior_key;
}

void Plan::Fix(ParameterFamily which) {
  families[static_cast<int>(which)] = {};
  if (which == ParameterFamily::kGaugeDrift) gauge_walk.reset();
}

bool Plan::HasCreep(const Finger& finger) const {
  return family(ParameterFamily::kGaugeCreepShare).free ||
         family(ParameterFamily::kGaugeCreepTime).free ||
         std::any_of(finger.gauges.begin(), finger.gauges.end(),
                     [](const Gauge& gauge) { return gauge.creep_share != 0; });
}

bool Plan::HasHysteresis(const Finger& finger) const {
  return family(ParameterFamily::kGaugeHysteresis).free ||
         std::any_of(
             finger.gauges.begin(), finger.gauges.end(),
             [](const Gauge& gauge) { return gauge.hysteresis_rad != 0; });
}

bool Plan::HasFlatGauges(const Finger& finger) const {
  return family(ParameterFamily::kGaugeFlatShare).free ||
         family(ParameterFamily::kGaugeFlatWidth).free ||
         std::any_of(finger.gauges.begin(), finger.gauges.end(),
                     [](const Gauge& gauge) { return gauge.flat_share != 0; });
}

Finger Plan::CutIntoPieces(const Finger& finger) const {
  Finger cut = finger;
  if (!family(ParameterFamily::kFrontPiece).free) return cut;
  for (const Side side : {Side::kFront, Side::kBack}) {
    auto& pieces = side == Side::kFront ? cut.front_pieces : cut.back_pieces;
    if (!pieces.empty()) continue;
    for (int i = 1; i <= piece_count; ++i) {
      pieces.push_back({BeamLength(finger, side) * i / piece_count, 1});
    }
  }
  return cut;
}

std::vector<FingerParameter> Plan::StaticsEffects(const Finger& finger) const {
  std::vector<FingerParameter> effects;
  for (const FingerParameter& parameter : AllParametersOf(finger)) {
    if (IsStaticsEffect(parameter.kind) &&
        family(static_cast<ParameterFamily>(parameter.kind)).free) {
      effects.push_back(parameter);
    }
  }
  return effects;
}

double Plan::PlaceStd_mm(double reach_mm) const {
  double variance = object_std_mm * object_std_mm;
  const std::pair<ParameterFamily, double> parts[] = {
      {ParameterFamily::kObjectOrigin, 1},
      {ParameterFamily::kObjectRotation, reach_mm * M_PI / 180},
      {ParameterFamily::kObjectScale, reach_mm / 100},
      {ParameterFamily::kObjectRadius, 1},
      {ParameterFamily::kSurfaceOffset, 1}};
  for (const auto& [which, mm] : parts) {
    if (!family(which).free) continue;
    variance += std::pow(mm * family(which).prior_std.value_or(
                                  std::numeric_limits<double>::infinity()),
                         2);
  }
  return std::sqrt(variance);
}

Plan ReadPlan(const std::string& path) {
  return ReadPlan(YamlMap::FromFile(path));
}

Plan ReadPlan(const YamlMap& yaml) {
  std::vector<std::string> keys = {"schema_version", "scene",
                                   "parameters",     "measurements",
                                   "robust_loss",    "holdout"};
  keys.insert(keys.end(), ColumnMappingKeys().begin(),
              ColumnMappingKeys().end());
  yaml.AllowOnly(keys);
  if (yaml.Integer("schema_version") != 1) {
    yaml.Fail("schema_version", "expected 1");
  }
  Plan plan;
  plan.scene = ReadPlanScene(yaml);
  RefuseBackContacts(plan.scene);
  if (plan.scene.object_std_mm || plan.scene.UsesCamera() ||
      plan.scene.smoothing) {
    yaml.Fail("scene",
              "a plan's scene has no measurements and no smoothing: the plan "
              "has measurements of its own");
  }
  if (plan.scene.gauge_offset_walk) {
    yaml.Fail(
        "scene",
        "a plan's scene has no gauge_offset_walk; expected "
        "parameters: {gauge_drift: {walk_std_V_per_sqrt_h, knot_every_s}}");
  }
  if (plan.scene.friction_std > 0) {
    yaml.Fail("scene",
              "a plan's scene has no friction_std; expected parameters: "
              "{friction: {prior_std: " +
                  NumberText(plan.scene.friction_std) + "}}");
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
    map.AllowOnly({"force_std_N", "gauge_std_V", "object_std_mm",
                   "contact_std_mm", "pin_std_mm", "tip_std_mm"});
    plan.force_std_stated = map.Has("force_std_N");
    plan.force_std_N = map.PositiveNumber("force_std_N", plan.force_std_N);
    const auto read = [&](const char* key, std::optional<double>* std) {
      if (map.Has(key)) *std = map.PositiveNumber(key);
    };
    read("gauge_std_V", &plan.gauge_std_V);
    read("pin_std_mm", &plan.pin_std_mm);
    read("tip_std_mm", &plan.tip_std_mm);
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
    if (plan.loss == RobustLoss::kNone && map.Has("scale")) {
      map.Fail("scale", "scale: type none has no scale");
    }
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
  plan.columns = ReadColumnMapping(yaml);
  plan.columns.AddMissing(plan.scene.columns);
  return plan;
}

}  // namespace finray
