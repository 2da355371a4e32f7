#ifndef FINRAY_CALIB_PROBLEM_PLAN_H_
#define FINRAY_CALIB_PROBLEM_PLAN_H_

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "finray/finger/finger_parameter.h"
#include "finray/scene/scene.h"

namespace finray {

/// The kinds of parameters that a calibration may vary. The first ones belong
/// to the finger and have the numbers of FingerParameterKind. The others belong
/// to the logs: the frame of object positions and the radius of the object, the
/// terms that the force sensor and the gauges add, and the origin of camera
/// positions.
enum class ParameterFamily {
  kFrontStiffness = static_cast<int>(FingerParameterKind::kFrontStiffness),
  kBackStiffness = static_cast<int>(FingerParameterKind::kBackStiffness),
  kGaugeGain = static_cast<int>(FingerParameterKind::kGaugeGain),
  kGaugeOffset = static_cast<int>(FingerParameterKind::kGaugeOffset),
  kRibLength = static_cast<int>(FingerParameterKind::kRibLength),
  kGaugeCurvature = static_cast<int>(FingerParameterKind::kGaugeCurvature),
  kGaugeStart = static_cast<int>(FingerParameterKind::kGaugeStart),
  kGaugeLength = static_cast<int>(FingerParameterKind::kGaugeLength),
  kGaugeCreepShare = static_cast<int>(FingerParameterKind::kGaugeCreepShare),
  kGaugeCreepTime = static_cast<int>(FingerParameterKind::kGaugeCreepTime),
  kGaugeFlatShare = static_cast<int>(FingerParameterKind::kGaugeFlatShare),
  kGaugeFlatWidth = static_cast<int>(FingerParameterKind::kGaugeFlatWidth),
  kGaugeHysteresis = static_cast<int>(FingerParameterKind::kGaugeHysteresis),
  kHingeStiffness = static_cast<int>(FingerParameterKind::kHingeStiffness),
  kRibBending = static_cast<int>(FingerParameterKind::kRibBending),
  kFrontPiece = static_cast<int>(FingerParameterKind::kFrontPiece),
  kBackPiece = static_cast<int>(FingerParameterKind::kBackPiece),
  kFrontHinge = static_cast<int>(FingerParameterKind::kFrontHinge),
  kBackHinge = static_cast<int>(FingerParameterKind::kBackHinge),
  kFrontClamp = static_cast<int>(FingerParameterKind::kFrontClamp),
  kBackClamp = static_cast<int>(FingerParameterKind::kBackClamp),
  kBackAngle = static_cast<int>(FingerParameterKind::kBackAngle),
  kSurfaceOffset = static_cast<int>(FingerParameterKind::kSurfaceOffset),
  kFriction = static_cast<int>(FingerParameterKind::kFriction),
  kObjectOrigin = kFingerParameterKinds,
  kObjectRotation,
  kObjectScale,
  kObjectRadius,
  kForceScale,
  kForceOffset,
  kForceTimeOffset,
  kForceTilt,
  kForceWeight,
  kTemperatureCoefficient,
  kGaugeDrift,
  kCameraOrigin,
};
constexpr int kParameterFamilies = kFingerParameterKinds + 12;

/// Says whether a family is varied, and its prior.
struct FamilyPlan {
  bool free = false;
  /// Std of the prior; empty if there is none. It is in percent of the initial
  /// value for stiffness, gains, scales and times, else in the unit that the
  /// key of the plan names.
  std::optional<double> prior_std;
  /// Each log has a value of its own.
  bool per_log = false;
};

/// An offset that wanders. It is linear between knots, and each log begins with
/// a knot. The change from knot to knot has this std.
struct GaugeWalk {
  double std_V_per_sqrt_h;
  double knot_every_s;
};

enum class RobustLoss { kNone, kHuber, kCauchy };
enum class HoldoutBy { kNothing, kLog, kBlock };

/// A plan YAML: what to calibrate, and from which measurements.
struct Plan {
  Scene scene;
  std::array<FamilyPlan, kParameterFamilies> families;
  /// How gauges drift if the plan says that they do; empty: at a constant rate.
  std::optional<GaugeWalk> gauge_walk;
  /// The pieces of a beam whose stiffness the plan varies, unless the finger
  /// has pieces.
  int piece_count = 5;
  /// The temperature coefficient counts from here.
  double reference_temperature_C = 20;
  /// The std of a row. Where the plan states none, 0.02 N is that of a row that
  /// is one reading, and rows that are means have the noise that their log
  /// tells.
  double force_std_N = 0.02;
  bool force_std_stated = false;
  /// The std of a row. It replaces the noise_V of each gauge, in the calibrated
  /// finger too where no scatter of readings is known (SetReadingNoise). Where
  /// the plan states none, rows that are means of n readings have noise_V /
  /// sqrt(n).
  std::optional<double> gauge_std_V;
  double object_std_mm = 0.05;
  double contact_std_mm = 0.3;
  /// If empty, the columns of rib pins, or of the tip, are no measurements:
  /// simulated and estimated tables hold computed ones.
  std::optional<double> pin_std_mm, tip_std_mm;
  RobustLoss loss = RobustLoss::kNone;
  double loss_scale = 2;  ///< In standard deviations.
  HoldoutBy holdout_by = HoldoutBy::kNothing;
  double holdout_fraction = 0.2;
  /// How the logs are written: by the plan, and by its scene where the plan
  /// says nothing.
  ColumnMapping columns;

  const FamilyPlan& family(ParameterFamily which) const {
    return families[static_cast<int>(which)];
  }
  /// Varies the family no more.
  void Fix(ParameterFamily which);
  /// Says that the plan varies where gauges start or how long they are.
  bool MovesGauges() const {
    return family(ParameterFamily::kGaugeStart).free ||
           family(ParameterFamily::kGaugeLength).free;
  }
  /// Returns the finger with beams cut into equal pieces, if the plan says so
  /// and a beam has none.
  Finger CutIntoPieces(const Finger& finger) const;
  /// The effects inside the equilibrium that the plan varies.
  std::vector<FingerParameter> StaticsEffects(const Finger& finger) const;
  /// Says that the finger's gauges creep or the plan asks whether they do.
  bool HasCreep(const Finger& finger) const;
  /// Says that the finger's gauges have hysteresis or the plan asks whether
  /// they do.
  bool HasHysteresis(const Finger& finger) const;
  /// Says that a gauge is less sensitive when flat or the plan asks whether.
  bool HasFlatGauges(const Finger& finger) const;
  /// Says that the force sensor reads 0 where nothing touches.
  bool ForceZeroIsKnown() const {
    return !family(ParameterFamily::kForceOffset).free &&
           !family(ParameterFamily::kForceWeight).free;
  }
  /// The std of an object's place against the finger, in mm: what its
  /// measurement and the priors of stage and radius have together, at places up
  /// to `reach_mm` from the origin. Infinite if one of these is free without a
  /// prior.
  double PlaceStd_mm(double reach_mm) const;
};

/// The family of the front beam where one key of a plan frees both beams, else
/// the family itself.
ParameterFamily FrontFamilyOf(ParameterFamily family);

/// The key of a family in a plan's `parameters`, and that of its prior.
const char* FamilyKeyOf(ParameterFamily family);
const char* PriorKeyOf(ParameterFamily family);

/// Reads a plan. Throws InputError for unknown keys and wrong units in a key.
Plan ReadPlan(const std::string& path);
Plan ReadPlan(const YamlMap& yaml);

}  // namespace finray

#endif  // FINRAY_CALIB_PROBLEM_PLAN_H_
