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
  Add(plan, ParameterFamily::kFrontStiffness, "front_stiffness_N_mm2", "N mm^2",
      &shared.ln_front_stiffness, true, 1);
  Add(plan, ParameterFamily::kBackStiffness, "back_stiffness_N_mm2", "N mm^2",
      &shared.ln_back_stiffness, true, 1);
  for (std::size_t j = 0; j < gains_V_per_rad.size(); ++j) {
    const std::string gauge = "gauge_" + std::to_string(j + 1);
    Add(plan, ParameterFamily::kGaugeGain, gauge + "_gain_V_per_rad", "V/rad",
        &gains_V_per_rad[j], false, std::abs(gains_V_per_rad[j]));
  }
  for (std::size_t j = 0; j < offsets_V.size(); ++j) {
    const std::string gauge = "gauge_" + std::to_string(j + 1);
    Add(plan, ParameterFamily::kGaugeOffset, gauge + "_offset_V", "V",
        &offsets_V[j], false, 1);
  }
  for (std::size_t i = 0; i < shared.rib_lengths_mm.size(); ++i) {
    Add(plan, ParameterFamily::kRibLength,
        "rib_" + std::to_string(i + 1) + "_length_mm", "mm",
        &shared.rib_lengths_mm[i], false, 1);
  }
  Add(plan, ParameterFamily::kObjectOrigin, "object_origin_x_mm", "mm",
      &object_origin_mm[0], false, 10);
  Add(plan, ParameterFamily::kObjectOrigin, "object_origin_y_mm", "mm",
      &object_origin_mm[1], false, 10);
}

void CalibrationParameters::Add(const Plan& plan, ParameterFamily family,
                                std::string name, std::string unit,
                                double* variable, bool is_log, double scale) {
  CalibrationParameter parameter;
  parameter.name = std::move(name);
  parameter.unit = std::move(unit);
  parameter.family = family;
  parameter.variable = variable;
  parameter.is_log = is_log;
  parameter.free = plan.family(family).free;
  parameter.initial = *variable;
  parameter.scale = scale;
  if (plan.family(family).prior_std) {
    const double prior_std = *plan.family(family).prior_std;
    const bool percent = is_log || family == ParameterFamily::kGaugeGain;
    parameter.prior_std = percent ? prior_std / 100 * scale : prior_std;
  }
  if (parameter.free) free_.push_back(static_cast<int>(all_.size()));
  all_.push_back(std::move(parameter));
}

Finger CalibrationParameters::Apply(const Finger& finger) const {
  Finger calibrated = finger;
  // exp(ln x) is not x: a stiffness that was not varied keeps its digits.
  if (all_[0].free) {
    calibrated.front_stiffness_N_mm2 = std::exp(shared.ln_front_stiffness);
  }
  if (all_[1].free) {
    calibrated.back_stiffness_N_mm2 = std::exp(shared.ln_back_stiffness);
  }
  for (std::size_t j = 0; j < gains_V_per_rad.size(); ++j) {
    calibrated.gauges[j].gain_V_per_rad = gains_V_per_rad[j];
    calibrated.gauges[j].offset_V = offsets_V[j];
  }
  for (std::size_t i = 0; i < shared.rib_lengths_mm.size(); ++i) {
    calibrated.ribs[i].length_mm = shared.rib_lengths_mm[i];
  }
  return calibrated;
}

}  // namespace finray
