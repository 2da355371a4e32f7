#include "finray/residuals/gauge_reading_residual.h"

#include <cmath>
#include <utility>

namespace finray {

GaugeReadingResidual::GaugeReadingResidual(const FrameEvaluation* frame,
                                           int gauge, const Measurements* row,
                                           double noise_V,
                                           std::vector<double> coefficients,
                                           const HistoryTerm& history,
                                           bool flat)
    : FrameResidual(frame, 1,
                    2 + (frame->movable_gauges() ? 2 : 0) + (flat ? 2 : 0) +
                        (history.history ? 3 : 0) + coefficients.size()),
      gauge_(gauge),
      row_(*row),
      noise_V_(noise_V),
      kept_std_V_(history.history == nullptr
                      ? 0
                      : history.history->KeptStd_V(history.row)),
      coefficients_(std::move(coefficients)),
      history_(history.history),
      history_row_(history.row),
      flat_(flat) {}

double GaugeReadingResidual::std_V() const {
  const double std_V =
      row_.GaugeStd_V(static_cast<std::size_t>(gauge_), noise_V_);
  return history_ == nullptr ? std_V : std::hypot(std_V, kept_std_V_);
}

bool GaugeReadingResidual::Evaluate(double const* const* parameters,
                                    double* residuals,
                                    double** jacobians) const {
  if (!frame().valid()) return false;
  const double reading_V = row_.gauges_V[static_cast<std::size_t>(gauge_)];
  const double weight = std::isnan(reading_V) ? 0.0 : 1 / std_V();
  const double gain = *parameters[extra_block()];
  const double curvature = *parameters[extra_block() + 1];
  const int flat = extra_block() + 2;
  const int place = flat + (flat_ ? 2 : 0);
  const int history = place + (frame().movable_gauges() ? 2 : 0);
  const int first_term = history + (history_ ? 3 : 0);
  const int terms = static_cast<int>(coefficients_.size());
  const double angle = frame().outputs()[gauge_];
  Gauge gauge;
  gauge.curvature_per_rad = curvature;
  if (flat_) {
    gauge.flat_share = *parameters[flat];
    gauge.flat_width_rad = std::exp(*parameters[flat + 1]);
  }
  const double bent = gauge.Signal(angle);
  double volts = gain * bent;
  for (int k = 0; k < terms; ++k) {
    volts += coefficients_[k] * *parameters[first_term + k];
  }
  ReadingHistory::Row behind{};
  double share = 0, offset = 0, hysteresis_rad = 0;
  if (history_ != nullptr) {
    share = *parameters[history];
    hysteresis_rad = *parameters[history + 2];
    offset = *parameters[first_term];
    if (!(share > -1)) return false;
    behind = history_->At(history_row_, {share, *parameters[history + 1],
                                         std::abs(gain) * hysteresis_rad});
    volts +=
        share * (behind.lag.volts - offset / (1 + share)) - behind.play.volts;
  }
  residuals[0] = weight == 0 ? 0 : weight * (volts - reading_V);
  if (jacobians == nullptr) return true;
  gauge.gain_V_per_rad = gain;
  const double slope = weight * gauge.Slope(angle);
  SpreadRow(0, slope * frame().d_outputs().row(gauge_), jacobians);
  const auto set = [&](int block, double value) {
    if (jacobians[block] != nullptr) *jacobians[block] = value;
  };
  set(extra_block(), weight * bent);
  set(extra_block() + 1, weight * gain * angle * angle);
  if (flat_) {
    set(flat, weight * gain * gauge.SignalByFlatShare(angle));
    set(flat + 1,
        weight * gain * gauge.flat_width_rad * gauge.SignalByFlatWidth(angle));
  }
  if (frame().movable_gauges()) {
    set(place, slope * frame().by_place(gauge_)[0]);
    set(place + 1, slope * frame().by_place(gauge_)[1]);
  }
  for (int k = 0; k < terms; ++k)
    set(first_term + k, weight * coefficients_[k]);
  if (history_ == nullptr) return true;
  const double rest = 1 + share;
  const auto& [lag, play, play_std_V] = behind;
  set(extra_block(),
      weight * (bent - std::copysign(hysteresis_rad, gain) * play.by_width));
  set(history, weight * (lag.volts + share * lag.by_share -
                         offset / (rest * rest) - play.by_share));
  set(history + 1, weight * (share * lag.by_ln_time - play.by_ln_time));
  set(history + 2, -weight * std::abs(gain) * play.by_width);
  set(first_term, weight * (coefficients_[0] - share / rest));
  return true;
}

}  // namespace finray
