#include "finray/calib/problem/parameters.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "finray/finger/geometry.h"
#include "finray/io/error.h"

namespace finray {
namespace {

// Returns the last log in which a row of the finger is not held out, or the
// last one of the bench if there is none.
int LastFitted(const CalibrationLogs& logs) {
  int finger = -1, bench = -1;
  for (const CalibrationFrame& frame : logs.frames) {
    if (frame.held_out) continue;
    int& last = frame.IsBench() ? bench : finger;
    last = std::max(last, frame.log);
  }
  return finger >= 0 ? finger : bench;
}

// Returns the std at which a lab would call a prior a guess. Drift and
// temperature coefficients are small, so that zero is a good guess for them.
double VagueStd(const CalibrationParameter& parameter) {
  switch (parameter.family) {
    case ParameterFamily::kGaugeGain:
    case ParameterFamily::kRibBending:
      return 0.2 * parameter.scale;
    case ParameterFamily::kGaugeOffset:
      return 0.01;
    case ParameterFamily::kGaugeCurvature:
    case ParameterFamily::kGaugeCreepTime:
    case ParameterFamily::kGaugeFlatShare:
    case ParameterFamily::kGaugeFlatWidth:
      return 1;
    case ParameterFamily::kGaugeHysteresis:
      return 0.02;
    case ParameterFamily::kGaugeStart:
    case ParameterFamily::kGaugeLength:
      return 2;
    case ParameterFamily::kHingeStiffness:
      return 50;
    case ParameterFamily::kFrontHinge:
    case ParameterFamily::kBackHinge:
    case ParameterFamily::kBackAngle:
    case ParameterFamily::kSurfaceOffset:
      return 2;
    case ParameterFamily::kFrontClamp:
    case ParameterFamily::kBackClamp:
      return 1e-3;
    case ParameterFamily::kObjectOrigin:
    case ParameterFamily::kObjectRadius:
    case ParameterFamily::kCameraOrigin:
      return 1;
    case ParameterFamily::kObjectRotation:
    case ParameterFamily::kForceTilt:
      return 2;
    case ParameterFamily::kObjectScale:
      return 0.05;
    case ParameterFamily::kTemperatureCoefficient:
    case ParameterFamily::kGaugeDrift:
      return std::numeric_limits<double>::infinity();
    default:
      return 0.2;
  }
}

// A free hinge stiffness is one number for all hinges.
void RefuseUnequalHinges(const Finger& finger) {
  const double one = finger.ribs[0].front_hinge_N_mm_per_rad;
  if (std::isinf(one)) {
    throw InputError(
        "plan: hinge_stiffness is free, but the finger's ribs are clamped to "
        "the beams; give them a hinge_stiffness_N_mm_per_rad to start from");
  }
  for (const Rib& rib : finger.ribs) {
    if (rib.front_hinge_N_mm_per_rad != one ||
        rib.back_hinge_N_mm_per_rad != one) {
      throw InputError(
          "plan: hinge_stiffness is free, so all hinges share one value, but "
          "the finger's hinge_stiffness_N_mm_per_rad differ; give all ribs the "
          "same one");
    }
  }
}

void RefuseRibsThatDoNotBend(const Finger& finger, const Plan& plan) {
  if (plan.family(ParameterFamily::kRibBending).free &&
      FirstBendingRib(finger) == nullptr) {
    throw InputError(
        "plan: rib_bending_stiffness is free, but no rib has a "
        "bending_stiffness_N_mm2 to start from");
  }
}

}  // namespace

double CalibrationParameter::Value(double at) const {
  return is_log ? std::exp(at) : at;
}

double CalibrationParameter::ValueStd(double at, double std) const {
  return is_log ? std::exp(at) * std : std;
}

double PriorStdOf(const CalibrationParameter& parameter, double in_plan) {
  const bool percent = parameter.is_log ||
                       parameter.family == ParameterFamily::kGaugeGain ||
                       parameter.family == ParameterFamily::kRibBending ||
                       parameter.family == ParameterFamily::kFrontPiece ||
                       parameter.family == ParameterFamily::kBackPiece;
  return percent ? in_plan / 100 * parameter.scale : in_plan;
}

CalibrationParameters::CalibrationParameters(const Finger& finger,
                                             const Plan& plan,
                                             const CalibrationLogs& logs)
    : shared(SharedParameters::Of(finger, plan.StaticsEffects(finger))),
      readings(finger, plan, logs),
      object_radius_mm(plan.scene.circle_radius_mm().value_or(0)),
      friction_(plan.scene.friction_coefficient),
      held_out_(logs.HeldOut()),
      last_fitted_(LastFitted(logs)),
      origin_per_log_(plan.family(ParameterFamily::kObjectOrigin).per_log),
      rotation_per_log_(plan.family(ParameterFamily::kObjectRotation).per_log),
      origins_mm_(origin_per_log_ ? logs.paths.size() : 1, {0, 0}),
      rotations_deg_(rotation_per_log_ ? logs.paths.size() : 1, 0.0) {
  for (const Gauge& gauge : finger.gauges) {
    gains_V_per_rad.push_back(gauge.gain_V_per_rad);
    curvatures_per_rad.push_back(gauge.curvature_per_rad);
    creep_shares.push_back(gauge.creep_share);
    ln_creep_times.push_back(std::log(gauge.creep_time_constant_s));
    hystereses_rad.push_back(gauge.hysteresis_rad);
    flat_shares.push_back(gauge.flat_share);
    ln_flat_widths.push_back(std::log(gauge.flat_width_rad));
  }
  if (plan.family(ParameterFamily::kFriction).free) {
    shared.friction_varies = true;
    shared.effect_values.push_back(friction_);
  }
  RefuseRibsThatDoNotBend(finger, plan);
  if (plan.HasCreep(finger) || plan.HasHysteresis(finger)) {
    ReadHistories(finger, logs);
  }
  flat_ = plan.HasFlatGauges(finger);
  if (plan.family(ParameterFamily::kForceTimeOffset).free) ReadForces(logs);
  for (const FingerParameter& parameter : AllParametersOf(finger)) {
    const auto family = static_cast<ParameterFamily>(parameter.kind);
    if (IsEffect(parameter.kind) && !plan.family(family).free) continue;
    AddOfFinger(finger, plan, logs, parameter);
  }
  AddFriction(plan);
  AddOrigins(plan, logs);
  AddStage(plan, logs);
  AddForceSensor(plan, logs);
  AddTemperature(plan);
  AddDrift(plan, logs);
  AddCamera(plan);
}

Gauge CalibrationParameters::Present(const Finger& finger, int gauge) const {
  Gauge present = finger.gauges[gauge];
  present.gain_V_per_rad = gains_V_per_rad[gauge];
  present.curvature_per_rad = curvatures_per_rad[gauge];
  present.flat_share = flat_shares[gauge];
  present.flat_width_rad = std::exp(ln_flat_widths[gauge]);
  return present;
}

void CalibrationParameters::AddOfFinger(const Finger& finger, const Plan& plan,
                                        const CalibrationLogs& logs,
                                        const FingerParameter& of_finger) {
  CalibrationParameter parameter;
  parameter.name = ParameterName(of_finger);
  parameter.unit = ParameterUnit(of_finger.kind);
  parameter.family = static_cast<ParameterFamily>(of_finger.kind);
  parameter.of_finger = of_finger;
  const int index = of_finger.index;
  switch (of_finger.kind) {
    case FingerParameterKind::kFrontStiffness:
      parameter.variable = &shared.ln_front_stiffness;
      parameter.is_log = true;
      break;
    case FingerParameterKind::kBackStiffness:
      parameter.variable = &shared.ln_back_stiffness;
      parameter.is_log = true;
      break;
    case FingerParameterKind::kGaugeGain:
      parameter.gauge = index;
      parameter.variable = &gains_V_per_rad[index];
      parameter.scale = std::abs(*parameter.variable);
      break;
    case FingerParameterKind::kGaugeOffset:
      parameter.gauge = index;
      if (plan.family(parameter.family).per_log) {
        for (int log = 0; log < static_cast<int>(logs.paths.size()); ++log) {
          CalibrationParameter of_log = parameter;
          of_log.variable = of_log.block = readings.offset_V(index, log);
          if (log != last_fitted_) of_log.of_finger.reset();
          const bool read = AnyFitted(logs, log, [&](const auto& frame) {
            return std::isfinite(frame.gauges_V[index]);
          });
          if (!read && !of_log.of_finger) continue;
          AddOfLog(plan, logs, log, std::move(of_log));
        }
        return;
      }
      parameter.variable = readings.offset_V(index, 0);
      break;
    case FingerParameterKind::kRibLength:
      parameter.variable = &shared.rib_lengths_mm[index];
      break;
    case FingerParameterKind::kGaugeCurvature:
      parameter.variable = &curvatures_per_rad[index];
      break;
    case FingerParameterKind::kGaugeStart:
      parameter.variable = &shared.gauge_starts_mm[index];
      break;
    case FingerParameterKind::kGaugeLength:
      parameter.variable = &shared.gauge_lengths_mm[index];
      break;
    case FingerParameterKind::kGaugeCreepShare:
      parameter.variable = &creep_shares[index];
      parameter.scale = 0.1;
      break;
    case FingerParameterKind::kGaugeCreepTime:
      parameter.variable = &ln_creep_times[index];
      parameter.is_log = true;
      break;
    case FingerParameterKind::kGaugeFlatShare:
      parameter.variable = &flat_shares[index];
      parameter.scale = 0.1;
      break;
    case FingerParameterKind::kGaugeFlatWidth:
      parameter.variable = &ln_flat_widths[index];
      parameter.is_log = true;
      break;
    case FingerParameterKind::kGaugeHysteresis:
      parameter.variable = &hystereses_rad[index];
      parameter.scale = 1e-3;
      break;
    case FingerParameterKind::kHingeStiffness:
      RefuseUnequalHinges(finger);
      parameter.scale = 10;
      break;
    case FingerParameterKind::kRibBending:
      parameter.scale = ParameterValue(finger, of_finger);
      break;
    case FingerParameterKind::kFrontClamp:
    case FingerParameterKind::kBackClamp:
      parameter.scale = 1e-4;
      break;
    case FingerParameterKind::kFrontPiece:
    case FingerParameterKind::kBackPiece:
    case FingerParameterKind::kFrontHinge:
    case FingerParameterKind::kBackHinge:
    case FingerParameterKind::kBackAngle:
    case FingerParameterKind::kSurfaceOffset:
    case FingerParameterKind::kFriction:  // see AddFriction
      break;
  }
  parameter.block = of_finger.kind == FingerParameterKind::kRibLength
                        ? shared.rib_lengths_mm.data()
                        : parameter.variable;
  if (IsStaticsEffect(of_finger.kind)) {
    const auto at =
        std::find(shared.effects.begin(), shared.effects.end(), of_finger);
    parameter.block = shared.effect_values.data();
    parameter.variable = parameter.block + (at - shared.effects.begin());
  }
  Add(plan, std::move(parameter));
}

void CalibrationParameters::Add(const Plan& plan,
                                CalibrationParameter parameter, bool held_out) {
  const FamilyPlan& family = plan.family(parameter.family);
  parameter.free = family.free && !held_out;
  parameter.initial = *parameter.variable;
  if (family.prior_std) {
    parameter.prior_std = PriorStdOf(parameter, *family.prior_std);
  }
  parameter.vague_std = VagueStd(parameter);
  if (parameter.free) free_.push_back(static_cast<int>(all_.size()));
  all_.push_back(std::move(parameter));
}

FrameParameters CalibrationParameters::Of(const CalibrationFrame& frame) {
  FrameParameters of;
  of.finger = &shared;
  of.gains_V_per_rad = gains_V_per_rad.data();
  of.curvatures_per_rad = curvatures_per_rad.data();
  of.readings.reserve(frame.gauges_V.size());
  for (std::size_t j = 0; j < frame.gauges_V.size(); ++j) {
    of.readings.push_back(readings.Of(frame, static_cast<int>(j)));
    if (!histories_.empty()) {
      of.histories.push_back(HistoryOf(frame, static_cast<int>(j)));
    }
  }
  if (flat_) {
    of.flat_shares = flat_shares.data();
    of.ln_flat_widths = ln_flat_widths.data();
  }
  of.ln_force_scale = &ln_force_scale;
  of.force_offset_N = &force_offset_N;
  of.force_offset_xy_N = force_offset_xy_N;
  of.force_tilt_deg = &force_tilt_deg;
  of.force_weight_N = force_weight_N;
  if (!forces_N_.empty()) {
    of.forces_N = &forces_N_[frame.log];
    of.force_time_offset_s = &force_time_offset_s;
  }
  of.object_origin_mm = object_origin_mm(frame.log);
  of.object_rotation_deg = object_rotation_deg(frame.log);
  of.ln_object_scale = &ln_object_scale;
  of.object_radius_mm = &object_radius_mm;
  of.camera_origin_mm = camera_origin_mm;
  return of;
}

Eigen::VectorXd CalibrationParameters::Units() const {
  Eigen::VectorXd units(static_cast<Eigen::Index>(free_.size()));
  for (std::size_t k = 0; k < free_.size(); ++k) {
    const CalibrationParameter& p = all_[free_[k]];
    units[static_cast<Eigen::Index>(k)] = p.prior_std.value_or(p.scale);
  }
  return units;
}

Finger CalibrationParameters::Apply(const Finger& finger) const {
  Finger calibrated = finger;
  // exp(ln x) is not exactly x, so a fixed parameter keeps the digits that it
  // has.
  for (const int i : free_) {
    const CalibrationParameter& parameter = all_[i];
    if (!parameter.of_finger) continue;
    double value = parameter.Value(*parameter.variable);
    // No clamp turns against its moment: such a one counts as rigid. No loop
    // has a negative width.
    if (IsAtLeastZero(parameter.of_finger->kind)) value = std::max(0.0, value);
    SetParameter(*parameter.of_finger, value, &calibrated);
  }
  return calibrated;
}

Plan CalibrationParameters::Corrected(const Plan& plan) const {
  Plan corrected = plan;
  corrected.scene.friction_coefficient = friction();
  if (plan.scene.circle_radius_mm()) {
    corrected.scene.object->outline = Outline(CircleOutline{object_radius_mm});
  }
  return corrected;
}

void CalibrationParameters::CorrectForce(CalibrationFrame* frame) const {
  if (!forces_N_.empty()) {
    const std::array<LinearSignal, 3>& of_log = forces_N_[frame->log];
    const auto later = [&](int i) {
      return of_log[i].Change(frame->time_s, force_time_offset_s).value;
    };
    frame->force_xy_N += Eigen::Vector2d(later(0), later(1));
    frame->force_N += later(2);
  }
  const double scale = std::exp(ln_force_scale);
  frame->force_N = (frame->force_N - force_offset_N) / scale;
  const Eigen::Map<const Eigen::Vector2d> offset(force_offset_xy_N),
      weight(force_weight_N);
  const Eigen::Rotation2Dd tilt(force_tilt_deg * M_PI / 180),
      turn(frame->object_angle_rad);
  frame->force_xy_N =
      tilt.inverse() * (frame->force_xy_N - offset - turn * weight) / scale;
}

CalibrationLogs CalibrationParameters::Corrected(const CalibrationLogs& logs,
                                                 const Finger& calibrated) {
  CalibrationLogs corrected = logs;
  for (CalibrationFrame& frame : corrected.frames) {
    for (std::size_t j = 0; j < frame.gauges_V.size(); ++j) {
      const int gauge = static_cast<int>(j);
      frame.gauges_V[j] += calibrated.gauges[j].offset_V -
                           readings.Sum(frame, gauge) - OfHistory(frame, gauge);
    }
    frame.history_std_V = HistoryStd_V(frame);
    if (!frictions_.empty() && frame.contact) {
      frame.friction = FrictionOf(frame).At(friction());
    }
    CorrectForce(&frame);
    frame.object_mm = Stage(frame.log).InS(frame.object_mm);
    const Eigen::Map<const Eigen::Vector2d> camera(camera_origin_mm);
    for (SeenPin& pin : frame.pins) pin.at_mm += camera;
    frame.tip_mm += camera;
  }
  return corrected;
}

}  // namespace finray
