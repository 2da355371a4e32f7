#include "finray/calib/parameters.h"

#include <cmath>

namespace finray {

double CalibrationParameter::Value(double at) const {
  return is_log ? std::exp(at) : at;
}

double CalibrationParameter::ValueStd(double at, double std) const {
  return is_log ? std::exp(at) * std : std;
}

CalibrationParameters::CalibrationParameters(const Finger& finger,
                                             const Plan& plan)
    : shared(SharedParameters::Of(finger)) {
  for (const Gauge& gauge : finger.gauges) {
    gains_V_per_rad.push_back(gauge.gain_V_per_rad);
    offsets_V.push_back(gauge.offset_V);
  }
  for (const FingerParameter& parameter : ParametersOf(finger)) {
    AddOfFinger(plan, parameter);
  }
  AddOrigin(plan, "object_origin_x_mm", &object_origin_mm[0]);
  AddOrigin(plan, "object_origin_y_mm", &object_origin_mm[1]);
}

double* CalibrationParameters::Variable(const FingerParameter& parameter) {
  switch (parameter.kind) {
    case FingerParameterKind::kFrontStiffness:
      return &shared.ln_front_stiffness;
    case FingerParameterKind::kBackStiffness:
      return &shared.ln_back_stiffness;
    case FingerParameterKind::kGaugeGain:
      return &gains_V_per_rad[parameter.index];
    case FingerParameterKind::kGaugeOffset:
      return &offsets_V[parameter.index];
    case FingerParameterKind::kRibLength:
      break;
  }
  return &shared.rib_lengths_mm[parameter.index];
}

void CalibrationParameters::AddOfFinger(const Plan& plan,
                                        const FingerParameter& of_finger) {
  CalibrationParameter parameter;
  parameter.name = ParameterName(of_finger);
  parameter.unit = ParameterUnit(of_finger.kind);
  parameter.family = static_cast<ParameterFamily>(of_finger.kind);
  parameter.of_finger = of_finger;
  parameter.variable = Variable(of_finger);
  parameter.is_log = of_finger.kind == FingerParameterKind::kFrontStiffness ||
                     of_finger.kind == FingerParameterKind::kBackStiffness;
  if (of_finger.kind == FingerParameterKind::kGaugeGain) {
    parameter.scale = std::abs(*parameter.variable);
  }
  Add(plan, std::move(parameter));
}

void CalibrationParameters::AddOrigin(const Plan& plan, const char* name,
                                      double* variable) {
  CalibrationParameter parameter;
  parameter.name = name;
  parameter.unit = "mm";
  parameter.family = ParameterFamily::kObjectOrigin;
  parameter.variable = variable;
  parameter.scale = 10;
  Add(plan, std::move(parameter));
}

void CalibrationParameters::Add(const Plan& plan,
                                CalibrationParameter parameter) {
  const FamilyPlan& family = plan.family(parameter.family);
  parameter.free = family.free;
  parameter.initial = *parameter.variable;
  if (family.prior_std) {
    const bool percent =
        parameter.is_log || parameter.family == ParameterFamily::kGaugeGain;
    parameter.prior_std =
        percent ? *family.prior_std / 100 * parameter.scale : *family.prior_std;
  }
  if (parameter.free) free_.push_back(static_cast<int>(all_.size()));
  all_.push_back(std::move(parameter));
}

Finger CalibrationParameters::Apply(const Finger& finger) const {
  Finger calibrated = finger;
  // exp(ln x) is not x: what was not varied keeps its digits.
  for (const int i : free_) {
    const CalibrationParameter& parameter = all_[i];
    if (!parameter.of_finger) continue;
    SetParameter(*parameter.of_finger, parameter.Value(*parameter.variable),
                 &calibrated);
  }
  return calibrated;
}

}  // namespace finray
