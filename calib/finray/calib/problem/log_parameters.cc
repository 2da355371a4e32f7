// The parameters of what is around the finger: friction, stage, force sensor,
// temperature, drift, camera.

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "finray/calib/problem/parameters.h"
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

}  // namespace

void CalibrationParameters::ReadForces(const CalibrationLogs& logs) {
  forces_N_.resize(logs.paths.size());
  for (const CalibrationFrame& frame : logs.frames) {
    std::array<LinearSignal, 3>& of_log = forces_N_[frame.log];
    of_log[0].Add(frame.time_s, frame.force_xy_N.x());
    of_log[1].Add(frame.time_s, frame.force_xy_N.y());
    of_log[2].Add(frame.time_s, frame.force_N);
  }
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

}  // namespace finray
