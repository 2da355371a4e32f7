#ifndef FINRAY_CALIB_PLAN_H_
#define FINRAY_CALIB_PLAN_H_

#include <array>
#include <map>
#include <optional>
#include <string>

#include "finray/finger/finger_parameter.h"
#include "finray/sensing/scene.h"

namespace finray {

/// Kinds of parameters a calibration may vary: a finger's, by their own
/// numbers, and where the object's positions are counted from.
enum class ParameterFamily {
  kFrontStiffness = static_cast<int>(FingerParameterKind::kFrontStiffness),
  kBackStiffness = static_cast<int>(FingerParameterKind::kBackStiffness),
  kGaugeGain = static_cast<int>(FingerParameterKind::kGaugeGain),
  kGaugeOffset = static_cast<int>(FingerParameterKind::kGaugeOffset),
  kRibLength = static_cast<int>(FingerParameterKind::kRibLength),
  kObjectOrigin = kFingerParameterKinds,
};
constexpr int kParameterFamilies = kFingerParameterKinds + 1;

/// Whether a family is varied, and what is known of it before.
struct FamilyPlan {
  bool free = false;
  /// In percent of the initial value for stiffness and gains, V for offsets, mm
  /// for lengths and positions; empty: no prior.
  std::optional<double> prior_std;
};

enum class RobustLoss { kNone, kHuber, kCauchy };
enum class HoldoutBy { kNothing, kLog, kBlock };

/// What to calibrate from which measurements (the plan YAML).
struct Plan {
  Scene scene;
  std::array<FamilyPlan, kParameterFamilies> families;
  double force_std_N = 0.02;
  std::optional<double> gauge_std_V;  ///< else each gauge's noise_V.
  double object_std_mm = 0.05;
  double contact_std_mm = 0.3;
  RobustLoss loss = RobustLoss::kNone;
  double loss_scale = 2;  ///< in standard deviations.
  HoldoutBy holdout_by = HoldoutBy::kNothing;
  double holdout_fraction = 0.2;
  std::map<std::string, std::string> columns;

  const FamilyPlan& family(ParameterFamily which) const {
    return families[static_cast<int>(which)];
  }
};

/// Reads a plan. Throws InputError for unknown keys, wrong units in a key, and
/// for a parameter that this version cannot vary.
Plan ReadPlan(const std::string& path);

}  // namespace finray

#endif  // FINRAY_CALIB_PLAN_H_
