#include "finray/residuals/gauge_reading_residual.h"

#include <cmath>

namespace finray {

GaugeReadingResidual::GaugeReadingResidual(
    const FrameEvaluation* frame, int gauge, const double* reading_V,
    double std_V, const std::vector<double>& coefficients,
    const CreepTerm& creep)
    : FrameResidual(
          frame, 1,
          std::vector<int>(2 + (frame->movable_gauges() ? 2 : 0) +
                               (creep.history ? 2 : 0) + coefficients.size(),
                           1)),
      gauge_(gauge),
      reading_V_(reading_V),
      std_V_(std_V),
      coefficients_(coefficients),
      creep_(creep.history),
      creep_row_(creep.row) {}

bool GaugeReadingResidual::Evaluate(double const* const* parameters,
                                    double* residuals,
                                    double** jacobians) const {
  if (!frame().valid()) return false;
  const double weight = std::isnan(*reading_V_) ? 0.0 : 1 / std_V_;
  const double gain = *parameters[extra_block()];
  const double curvature = *parameters[extra_block() + 1];
  const int place = extra_block() + 2;
  const int creep = place + (frame().movable_gauges() ? 2 : 0);
  const int first_term = creep + (creep_ ? 2 : 0);
  const int terms = static_cast<int>(coefficients_.size());
  const double angle = frame().outputs()[gauge_];
  const double bent = angle * (1 + curvature * angle);
  double volts = gain * bent;
  for (int k = 0; k < terms; ++k) {
    volts += coefficients_[k] * *parameters[first_term + k];
  }
  CreepHistory::Lag lag{};
  double share = 0, offset = 0;
  if (creep_ != nullptr) {
    share = *parameters[creep];
    offset = *parameters[first_term];
    if (!(share > -1)) return false;
    lag = creep_->At(creep_row_, share, *parameters[creep + 1]);
    volts += share * (lag.volts - offset / (1 + share));
  }
  residuals[0] = weight == 0 ? 0 : weight * (volts - *reading_V_);
  if (jacobians == nullptr) return true;
  const double slope = weight * gain * (1 + 2 * curvature * angle);
  SpreadRow(0, slope * frame().d_outputs().row(gauge_), jacobians);
  const auto set = [&](int block, double value) {
    if (jacobians[block] != nullptr) *jacobians[block] = value;
  };
  set(extra_block(), weight * bent);
  set(extra_block() + 1, weight * gain * angle * angle);
  if (frame().movable_gauges()) {
    set(place, slope * frame().by_place(gauge_)[0]);
    set(place + 1, slope * frame().by_place(gauge_)[1]);
  }
  for (int k = 0; k < terms; ++k)
    set(first_term + k, weight * coefficients_[k]);
  if (creep_ == nullptr) return true;
  const double rest = 1 + share;
  set(creep,
      weight * (lag.volts + share * lag.by_share - offset / (rest * rest)));
  set(creep + 1, weight * share * lag.by_ln_time);
  set(first_term, weight * (coefficients_[0] - share / rest));
  return true;
}

}  // namespace finray
