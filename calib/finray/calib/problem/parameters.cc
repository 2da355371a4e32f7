#include "finray/calib/problem/parameters.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "finray/finger/gauge_play.h"
#include "finray/finger/geometry.h"
#include "finray/io/error.h"

namespace finray {
namespace {

std::string GaugeName(int gauge, const std::string& rest) {
  return "gauge_" + std::to_string(gauge + 1) + "_" + rest;
}

// Makes a parameter that belongs to the logs, in a block of its own.
CalibrationParameter OfLogs(ParameterFamily family, std::string name,
                            const char* unit, double* variable,
                            double scale = 1) {
  CalibrationParameter parameter;
  parameter.family = family;
  parameter.name = std::move(name);
  parameter.unit = unit;
  parameter.variable = parameter.block = variable;
  parameter.scale = scale;
  return parameter;
}

// Makes the x or y parameter of a pair that is one block.
CalibrationParameter OfAxis(ParameterFamily family, const std::string& name,
                            const std::string& unit, double* pair, int axis,
                            double scale) {
  CalibrationParameter parameter =
      OfLogs(family, name + (axis == 0 ? "_x_" : "_y_") + unit, unit.c_str(),
             pair + axis, scale);
  parameter.block = pair;
  return parameter;
}

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

// Without the place of an object nothing shows where its axes are.
bool HasPlace(const CalibrationFrame& frame) {
  return frame.contact && frame.object_mm.allFinite();
}

bool HasPlaces(const CalibrationLogs& logs) {
  return std::any_of(logs.frames.begin(), logs.frames.end(),
                     [](const CalibrationFrame& frame) {
                       return !frame.held_out && HasPlace(frame);
                     });
}

// Says whether `has` is true for a fitted frame of the log.
template <class Has>
bool AnyFitted(const CalibrationLogs& logs, int log, const Has& has) {
  return std::any_of(logs.frames.begin(), logs.frames.end(),
                     [&](const CalibrationFrame& frame) {
                       return frame.log == log && !frame.held_out && has(frame);
                     });
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

void CalibrationParameters::ReadHistories(const Finger& finger,
                                          const CalibrationLogs& logs) {
  const std::size_t gauges = gains_V_per_rad.size();
  for (std::size_t log = 0; log < logs.paths.size(); ++log) {
    histories_.emplace_back(gauges);
    for (std::size_t j = 0; j < gauges; ++j) {
      histories_.back()[j].set_noise_V(finger.gauges[j].noise_V);
    }
  }
  RowChange change(finger.gauges);
  int log = -1;
  for (const CalibrationFrame& frame : logs.frames) {
    if (frame.log != log) change.Restart();
    log = frame.log;
    const double moved2 = change.Next(frame.gauges_V);
    for (std::size_t j = 0; j < gauges; ++j) {
      histories_[log][j].Set(frame.row, frame.time_s, frame.gauges_V[j],
                             moved2);
    }
  }
}

void CalibrationParameters::ReadForces(const CalibrationLogs& logs) {
  forces_N_.resize(logs.paths.size());
  for (const CalibrationFrame& frame : logs.frames) {
    std::array<LinearSignal, 3>& of_log = forces_N_[frame.log];
    of_log[0].Add(frame.time_s, frame.force_xy_N.x());
    of_log[1].Add(frame.time_s, frame.force_xy_N.y());
    of_log[2].Add(frame.time_s, frame.force_N);
  }
}

HistoryTerm CalibrationParameters::HistoryOf(const CalibrationFrame& frame,
                                             int gauge) {
  if (histories_.empty() || frame.IsBench()) return {};
  return {&histories_[frame.log][gauge], frame.row, &creep_shares[gauge],
          &ln_creep_times[gauge], &hystereses_rad[gauge]};
}

ReadingHistory::Values CalibrationParameters::HistoryValues(int gauge) const {
  return {creep_shares[gauge], ln_creep_times[gauge],
          std::abs(gains_V_per_rad[gauge]) * hystereses_rad[gauge]};
}

double CalibrationParameters::OfHistory(const CalibrationFrame& frame,
                                        int gauge) {
  const HistoryTerm term = HistoryOf(frame, gauge);
  if (term.history == nullptr) return 0;
  const ReadingHistory::Row behind =
      term.history->At(term.row, HistoryValues(gauge));
  return *term.share *
             (behind.lag.volts -
              *readings.offset_V(gauge, frame.log) / (1 + *term.share)) -
         behind.play.volts;
}

void CalibrationParameters::KeepHistoryStdAt(
    const std::vector<ReadingHistory::Values>& values) {
  kept_ = values;
  for (std::vector<ReadingHistory>& log : histories_) {
    for (std::size_t j = 0; j < kept_.size(); ++j) log[j].KeepStd(kept_[j]);
  }
}

bool CalibrationParameters::KeepHistoryStd() {
  if (histories_.empty()) return false;
  constexpr double kMuch = 0.03;  // of the width
  std::vector<ReadingHistory::Values> values;
  bool much = false;
  for (int j = 0; j < static_cast<int>(gains_V_per_rad.size()); ++j) {
    values.push_back(HistoryValues(j));
    const double before = kept_.empty() ? 0 : kept_[j].width_V;
    much |= std::abs(values[j].width_V - before) >
            kMuch * std::abs(gains_V_per_rad[j]) * 1e-3;
  }
  KeepHistoryStdAt(values);
  return much;
}

void CalibrationParameters::KeepHistoryStdOf(
    const CalibrationParameters& other) {
  if (!histories_.empty() && !other.kept_.empty()) {
    KeepHistoryStdAt(other.kept_);
  }
}

std::vector<double> CalibrationParameters::HistoryStd_V(
    const CalibrationFrame& frame) const {
  std::vector<double> std_V;
  if (kept_.empty() || frame.IsBench()) return std_V;
  for (const ReadingHistory& history : histories_[frame.log]) {
    std_V.push_back(history.KeptStd_V(frame.row));
  }
  return std_V;
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

void CalibrationParameters::AddFriction(const Plan& plan) {
  if (!shared.friction_varies) return;
  CalibrationParameter friction =
      OfLogs(ParameterFamily::kFriction, "friction_coefficient", "1",
             &shared.effect_values.back(), 0.1);
  friction.block = shared.effect_values.data();
  Add(plan, std::move(friction));
}

void CalibrationParameters::AddOrigins(const Plan& plan,
                                       const CalibrationLogs& logs) {
  const bool placed = HasPlaces(logs);
  for (int log = 0; log < static_cast<int>(origins_mm_.size()); ++log) {
    if (origin_per_log_ && !AnyFitted(logs, log, HasPlace)) continue;
    for (int axis = 0; axis < 2; ++axis) {
      CalibrationParameter parameter =
          OfAxis(ParameterFamily::kObjectOrigin, "object_origin", "mm",
                 origins_mm_[log].data(), axis, 10);
      origin_per_log_ ? AddOfLog(plan, logs, log, std::move(parameter))
                      : Add(plan, std::move(parameter), !placed);
    }
  }
}

void CalibrationParameters::AddStage(const Plan& plan,
                                     const CalibrationLogs& logs) {
  if (!HasPlaces(logs)) return;
  constexpr ParameterFamily kRotation = ParameterFamily::kObjectRotation;
  for (int log = 0; log < static_cast<int>(rotations_deg_.size()); ++log) {
    if (!plan.family(kRotation).free) break;
    CalibrationParameter rotation = OfLogs(kRotation, "object_rotation_deg",
                                           "deg", &rotations_deg_[log], 5);
    if (!rotation_per_log_) {
      Add(plan, std::move(rotation));
    } else if (AnyFitted(logs, log, HasPlace)) {
      AddOfLog(plan, logs, log, std::move(rotation));
    }
  }
  if (plan.family(ParameterFamily::kObjectScale).free) {
    CalibrationParameter scale = OfLogs(ParameterFamily::kObjectScale,
                                        "object_scale", "1", &ln_object_scale);
    scale.is_log = true;
    Add(plan, std::move(scale));
  }
  if (plan.family(ParameterFamily::kObjectRadius).free) {
    Add(plan, OfLogs(ParameterFamily::kObjectRadius, "object_radius_mm", "mm",
                     &object_radius_mm));
  }
}

void CalibrationParameters::AddForceSensor(const Plan& plan,
                                           const CalibrationLogs& logs) {
  if (plan.family(ParameterFamily::kForceScale).free) {
    CalibrationParameter scale = OfLogs(ParameterFamily::kForceScale,
                                        "force_scale", "1", &ln_force_scale);
    scale.is_log = true;
    Add(plan, std::move(scale));
  }
  if (plan.family(ParameterFamily::kForceTimeOffset).free) {
    Add(plan, OfLogs(ParameterFamily::kForceTimeOffset, "force_time_offset_s",
                     "s", &force_time_offset_s));
  }
  if (plan.family(ParameterFamily::kForceTilt).free) {
    Add(plan, OfLogs(ParameterFamily::kForceTilt, "force_tilt_deg", "deg",
                     &force_tilt_deg, 5));
  }
  for (int axis = 0; axis < 2; ++axis) {
    if (!plan.family(ParameterFamily::kForceWeight).free) break;
    Add(plan, OfAxis(ParameterFamily::kForceWeight, "force_weight", "N",
                     force_weight_N, axis, 1));
  }
  if (!plan.family(ParameterFamily::kForceOffset).free) return;
  bool magnitude = false, components = false;
  for (const CalibrationFrame& frame : logs.frames) {
    const bool both = frame.force_xy_N.allFinite();
    components |= both;
    magnitude |= !both && std::isfinite(frame.force_N);
  }
  if (magnitude) {
    Add(plan, OfLogs(ParameterFamily::kForceOffset, "force_offset_N", "N",
                     &force_offset_N));
  }
  for (int axis = 0; components && axis < 2; ++axis) {
    Add(plan, OfAxis(ParameterFamily::kForceOffset, "force_offset", "N",
                     force_offset_xy_N, axis, 1));
  }
}

void CalibrationParameters::AddTemperature(const Plan& plan) {
  if (!plan.family(ParameterFamily::kTemperatureCoefficient).free) return;
  for (int j = 0; j < static_cast<int>(gains_V_per_rad.size()); ++j) {
    Add(plan, OfLogs(ParameterFamily::kTemperatureCoefficient,
                     GaugeName(j, "temperature_coefficient_V_per_C"), "V/C",
                     readings.temperature_coefficient_V_per_C(j), 0.1));
  }
}

void CalibrationParameters::AddDrift(const Plan& plan,
                                     const CalibrationLogs& logs) {
  constexpr ParameterFamily kDrift = ParameterFamily::kGaugeDrift;
  if (!plan.family(kDrift).free) return;
  if (std::all_of(logs.frames.begin(), logs.frames.end(),
                  [](const CalibrationFrame& f) { return f.IsBench(); })) {
    throw InputError(
        "plan: gauge_drift is free, but no log is of the finger; gauges on the "
        "bench have no time_s");
  }
  const int gauges = static_cast<int>(gains_V_per_rad.size());
  for (int j = 0; !plan.gauge_walk && j < gauges; ++j) {
    Add(plan, OfLogs(kDrift, GaugeName(j, "drift_V_per_h"), "V/h",
                     readings.drift_V_per_h(j)));
  }
  for (int log = 0; log < static_cast<int>(logs.paths.size()); ++log) {
    for (int j = 0; j < gauges; ++j) {
      for (int step = 0; step < readings.walk_steps(log); ++step) {
        CalibrationParameter parameter = OfLogs(
            kDrift, GaugeName(j, "drift_" + std::to_string(step + 1) + "_V"),
            "V", readings.walk_step_V(j, log, step));
        parameter.prior_std = readings.walk_step_std_V(log);
        AddOfLog(plan, logs, log, std::move(parameter));
      }
    }
  }
}

void CalibrationParameters::AddCamera(const Plan& plan) {
  if (!plan.family(ParameterFamily::kCameraOrigin).free) return;
  for (int axis = 0; axis < 2; ++axis) {
    Add(plan, OfAxis(ParameterFamily::kCameraOrigin, "camera_origin", "mm",
                     camera_origin_mm, axis, 10));
  }
}

void CalibrationParameters::AddOfLog(const Plan& plan,
                                     const CalibrationLogs& logs, int log,
                                     CalibrationParameter parameter) {
  parameter.name += "[" + logs.names[log] + "]";
  Add(plan, std::move(parameter), held_out_[log]);
}

void CalibrationParameters::Add(const Plan& plan,
                                CalibrationParameter parameter, bool held_out) {
  const FamilyPlan& family = plan.family(parameter.family);
  parameter.free = family.free && !held_out;
  parameter.initial = *parameter.variable;
  if (family.prior_std) {
    const bool percent = parameter.is_log ||
                         parameter.family == ParameterFamily::kGaugeGain ||
                         parameter.family == ParameterFamily::kRibBending ||
                         parameter.family == ParameterFamily::kFrontPiece ||
                         parameter.family == ParameterFamily::kBackPiece;
    parameter.prior_std =
        percent ? *family.prior_std / 100 * parameter.scale : *family.prior_std;
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
    const double at_s = frame->time_s + force_time_offset_s;
    for (int i = 0; i < 2 && frame->force_xy_N.allFinite(); ++i) {
      frame->force_xy_N[i] = of_log[i].At(at_s).value;
    }
    if (std::isfinite(frame->force_N))
      frame->force_N = of_log[2].At(at_s).value;
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
    CorrectForce(&frame);
    frame.object_mm = Stage(frame.log).InS(frame.object_mm);
    const Eigen::Map<const Eigen::Vector2d> camera(camera_origin_mm);
    for (SeenPin& pin : frame.pins) pin.at_mm += camera;
    frame.tip_mm += camera;
  }
  return corrected;
}

}  // namespace finray
