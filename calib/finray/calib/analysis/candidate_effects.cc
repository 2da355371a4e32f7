#include "finray/calib/analysis/candidate_effects.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "finray/finger/geometry.h"

namespace finray {
namespace {

// Says whether there are rows of the finger, and all have a number.
template <class Number>
bool AllHave(const CalibrationLogs& logs, const Number& number) {
  bool any = false;
  for (const CalibrationFrame& frame : logs.frames) {
    if (frame.IsBench()) continue;
    if (!std::isfinite(number(frame))) return false;
    any = true;
  }
  return any;
}

bool HasClampedRib(const Finger& finger) {
  return std::any_of(finger.ribs.begin(), finger.ribs.end(),
                     [](const Rib& rib) {
                       return std::isinf(rib.front_hinge_N_mm_per_rad) ||
                              std::isinf(rib.back_hinge_N_mm_per_rad);
                     });
}

}  // namespace

// A new family needs a line here, and the score test and --explore know it.
const std::vector<CandidateEffect>& AllCandidateEffects() {
  using Family = ParameterFamily;
  constexpr double kAny = -std::numeric_limits<double>::infinity();
  constexpr double kMost = -kAny;
  static const std::vector<CandidateEffect> all = {
      {Family::kFrontStiffness, 50, "another front stiffness"},
      {Family::kBackStiffness, 50, "another back stiffness"},
      {Family::kGaugeGain, 20, "other gains of gauges", kAny, kMost, true},
      {Family::kGaugeOffset, 0.02, "moved offsets of gauges", kAny, kMost,
       true},
      {Family::kRibLength, 0.5, "ribs of other lengths"},
      {Family::kGaugeCurvature, 1, "gauges with a curved gain"},
      {Family::kGaugeStart, 1, "gauges beside their drawn places"},
      {Family::kGaugeLength, 1, "gauges of other lengths"},
      {Family::kGaugeCreepShare, 0.1, "gauges that creep", 0, 1},
      {Family::kGaugeCreepTime, 50, "another time constant of creep"},
      {Family::kGaugeFlatShare, 0.2, "gauges that are less sensitive when flat",
       0, 1},
      {Family::kGaugeFlatWidth, 50, "another width of what gauges call flat"},
      {Family::kGaugeHysteresis, 1e-3, "gauges with hysteresis", 0},
      {Family::kHingeStiffness, 20, "hinges that resist", 0},
      {Family::kRibBending, 50, "another bending stiffness of the ribs"},
      {Family::kFrontPiece, 1.5, "a stiffness that changes along the beams"},
      {Family::kFrontHinge, 0.5, "hinges beside their drawn places"},
      {Family::kFrontClamp, 2e-4, "clamps that give", 0},
      {Family::kBackAngle, 0.5, "another angle of the back beam"},
      {Family::kSurfaceOffset, 0.5, "a surface beside the beam"},
      {Family::kFriction, 0.3, "friction", 0, 1.5},
      {Family::kObjectOrigin, 0.5, "a shifted stage", kAny, kMost, true},
      {Family::kObjectRotation, 1, "a turned stage", kAny, kMost, true},
      {Family::kObjectScale, 1, "a stage of another scale"},
      {Family::kObjectRadius, 0.5, "another radius of the object"},
      {Family::kForceScale, 3, "another scale of the force sensor", kAny, kMost,
       true},
      {Family::kForceOffset, 0.1, "an offset of the force sensor", kAny, kMost,
       true},
      {Family::kForceTimeOffset, 0.1, "a force sensor that is late"},
      {Family::kForceTilt, 1, "a turned force sensor"},
      {Family::kForceWeight, 0.1, "a weight on the force sensor"},
      {Family::kTemperatureCoefficient, 0.001, "gauges that feel temperature"},
      {Family::kGaugeDrift, 0.01, "gauges that drift"},
      {Family::kCameraOrigin, 1, "a shifted camera"},
  };
  return all;
}

const CandidateEffect& CandidateOf(ParameterFamily family) {
  family = FrontFamilyOf(family);
  for (const CandidateEffect& effect : AllCandidateEffects()) {
    if (effect.family == family) return effect;
  }
  throw std::out_of_range("no candidate effect of this family");
}

std::optional<double> ImpossibleBound(const CalibrationParameter& parameter,
                                      double std) {
  const CandidateEffect& effect = CandidateOf(parameter.family);
  const double at = *parameter.variable;
  const double value = parameter.Value(at);
  const double off = kImpossibleStd * parameter.ValueStd(at, std);
  // The sign of friction is its direction.
  const double least =
      FrontFamilyOf(parameter.family) == ParameterFamily::kFriction
          ? -effect.most
          : effect.least;
  if (value + off < least) return least;
  if (value - off > effect.most) return effect.most;
  return {};
}

std::vector<CandidateEffect> CandidatesFor(const Finger& finger,
                                           const Plan& plan,
                                           const CalibrationLogs& logs) {
  const bool timed =
      AllHave(logs, [](const auto& frame) { return frame.time_s; });
  const bool warm =
      AllHave(logs, [](const auto& frame) { return frame.temperature_C; });
  const bool components = std::any_of(
      logs.frames.begin(), logs.frames.end(),
      [](const auto& frame) { return frame.force_xy_N.allFinite(); });
  const bool circle = plan.scene.circle_radius_mm().has_value();
  std::vector<CandidateEffect> candidates;
  for (const CandidateEffect& effect : AllCandidateEffects()) {
    using Family = ParameterFamily;
    if (plan.family(effect.family).free) continue;
    if (!TimesAllow(effect.family, logs)) continue;
    switch (effect.family) {
      case Family::kTemperatureCoefficient:
        if (!warm) continue;
        break;
      case Family::kGaugeDrift:
      case Family::kGaugeCreepShare:
      case Family::kForceTimeOffset:
        if (!timed) continue;
        break;
      case Family::kGaugeCreepTime:
        if (!timed || !plan.HasCreep(finger)) continue;
        break;
      case Family::kGaugeFlatWidth:
        if (!plan.HasFlatGauges(finger)) continue;
        break;
      case Family::kForceTilt:
      case Family::kForceWeight:
        if (!components) continue;
        break;
      case Family::kHingeStiffness:
        if (finger.ribs.empty() || HasClampedRib(finger)) continue;
        break;
      case Family::kRibBending:
        // Ribs on hinges have no stiffness to start from.
        if (FirstBendingRib(finger) == nullptr) continue;
        break;
      case Family::kFrontHinge:
        if (finger.ribs.empty()) continue;
        break;
      case Family::kSurfaceOffset:
        // Without friction it is the same as another radius.
        if (!circle || (plan.scene.friction_coefficient == 0 &&
                        !plan.family(Family::kFriction).free)) {
          continue;
        }
        break;
      case Family::kObjectRadius:
        if (!circle) continue;
        break;
      default:
        break;
    }
    candidates.push_back(effect);
  }
  return candidates;
}

bool CanDifferByLog(ParameterFamily family) {
  return family == ParameterFamily::kGaugeOffset ||
         family == ParameterFamily::kObjectOrigin ||
         family == ParameterFamily::kObjectRotation;
}

Plan Freed(const Plan& plan, const CandidateEffect& effect) {
  Plan freed = plan;
  FamilyPlan& family = freed.families[static_cast<int>(effect.family)];
  if (effect.per_log && family.free) {
    family.per_log = true;
    return freed;
  }
  family = {};
  family.per_log = effect.per_log;
  family.free = true;
  family.prior_std = effect.prior_std;
  for (int i = 0; i < kParameterFamilies; ++i) {
    if (FrontFamilyOf(static_cast<ParameterFamily>(i)) == effect.family) {
      freed.families[i] = family;
    }
  }
  return freed;
}

}  // namespace finray
