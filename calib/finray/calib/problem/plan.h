#ifndef FINRAY_CALIB_PROBLEM_PLAN_H_
#define FINRAY_CALIB_PROBLEM_PLAN_H_

#include <array>
#include <map>
#include <optional>
#include <string>

#include "finray/finger/finger_parameter.h"
#include "finray/scene/scene.h"

namespace finray {

/// Kinds of parameters a calibration may vary: a finger's, by their own
/// numbers, and those of the logs: where the object's positions are counted
/// from, what the force sensor and the gauges add, where the camera counts
/// from.
enum class ParameterFamily {
  kFrontStiffness = static_cast<int>(FingerParameterKind::kFrontStiffness),
  kBackStiffness = static_cast<int>(FingerParameterKind::kBackStiffness),
  kGaugeGain = static_cast<int>(FingerParameterKind::kGaugeGain),
  kGaugeOffset = static_cast<int>(FingerParameterKind::kGaugeOffset),
  kRibLength = static_cast<int>(FingerParameterKind::kRibLength),
  kObjectOrigin = kFingerParameterKinds,
  kForceScale,
  kForceOffset,
  kTemperatureCoefficient,
  kGaugeDrift,
  kCameraOrigin,
};
constexpr int kParameterFamilies = kFingerParameterKinds + 6;

/// Says if a family is varied, and its prior.
struct FamilyPlan {
  bool free = false;
  /// In percent of the initial value for stiffness, gains and the force scale,
  /// else in the unit that the plan's key names; empty: no prior.
  std::optional<double> prior_std;
  /// A value for each log instead of one for all.
  bool per_log = false;
};

/// An offset that wanders: linear between knots, each log beginning with one,
/// and from knot to knot a change of this std.
struct GaugeWalk {
  double std_V_per_sqrt_h;
  double knot_every_s;
};

enum class RobustLoss { kNone, kHuber, kCauchy };
enum class HoldoutBy { kNothing, kLog, kBlock };

/// A plan YAML: what to calibrate, from which measurements.
struct Plan {
  Scene scene;
  std::array<FamilyPlan, kParameterFamilies> families;
  /// How gauges drift if they do; empty: at a constant rate.
  std::optional<GaugeWalk> gauge_walk;
  /// Where the temperature coefficient counts from.
  double reference_temperature_C = 20;
  double force_std_N = 0.02;
  std::optional<double> gauge_std_V;  ///< else each gauge's noise_V.
  double object_std_mm = 0.05;
  double contact_std_mm = 0.3;
  /// Empty: columns of rib pins, or of the tip, are no measurements. Simulated
  /// and estimated tables have them computed.
  std::optional<double> pin_std_mm, tip_std_mm;
  RobustLoss loss = RobustLoss::kNone;
  double loss_scale = 2;  ///< in standard deviations.
  HoldoutBy holdout_by = HoldoutBy::kNothing;
  double holdout_fraction = 0.2;
  std::map<std::string, std::string> columns;

  const FamilyPlan& family(ParameterFamily which) const {
    return families[static_cast<int>(which)];
  }
};

/// Reads a plan. Throws InputError for unknown keys and wrong units in a key.
Plan ReadPlan(const std::string& path);

}  // namespace finray

#endif  // FINRAY_CALIB_PROBLEM_PLAN_H_
