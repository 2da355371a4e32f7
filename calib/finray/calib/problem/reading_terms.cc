#include "finray/calib/problem/reading_terms.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "finray/io/error.h"

namespace finray {
namespace {

constexpr double kSecondsPerHour = 3600;
// The largest number of steps of a gauge in a log. More would mean a parameter
// for a few frames.
constexpr int kMostSteps = 100;

}  // namespace

ReadingTerms::ReadingTerms(const Finger& finger, const Plan& plan,
                           const CalibrationLogs& logs)
    : gauges_(static_cast<int>(finger.gauges.size())),
      per_log_(plan.family(ParameterFamily::kGaugeOffset).per_log),
      rate_(plan.family(ParameterFamily::kGaugeDrift).free && !plan.gauge_walk),
      temperature_(plan.family(ParameterFamily::kTemperatureCoefficient).free),
      walk_(plan.gauge_walk),
      reference_C_(plan.reference_temperature_C),
      spans_(logs.paths.size()),
      rates_V_per_h_(gauges_, 0.0),
      temperature_V_per_C_(gauges_, 0.0) {
  const std::size_t copies = per_log_ ? logs.paths.size() : 1;
  for (std::size_t copy = 0; copy < copies; ++copy) {
    for (const Gauge& gauge : finger.gauges) {
      offsets_V_.push_back(gauge.offset_V);
    }
  }
  constexpr double kInf = std::numeric_limits<double>::infinity();
  for (Span& span : spans_) span = {kInf, -kInf, 0};
  earliest_s_ = kInf;
  for (const CalibrationFrame& frame : logs.frames) {
    if (frame.IsBench() || std::isnan(frame.time_s)) continue;
    Span& span = spans_[frame.log];
    span.first_s = std::min(span.first_s, frame.time_s);
    span.last_s = std::max(span.last_s, frame.time_s);
    earliest_s_ = std::min(earliest_s_, frame.time_s);
  }
  walks_V_.resize(spans_.size());
  if (!walk_) return;
  const std::vector<bool> held_out = logs.HeldOut();
  for (std::size_t log = 0; log < spans_.size(); ++log) {
    Span& span = spans_[log];
    if (held_out[log] || span.last_s <= span.first_s) continue;
    const double steps =
        std::ceil((span.last_s - span.first_s) / walk_->knot_every_s);
    if (steps > kMostSteps) {
      throw InputError(logs.paths[log] + ": knots every " +
                       std::to_string(std::lround(walk_->knot_every_s)) +
                       " s over " +
                       std::to_string(std::lround(span.last_s - span.first_s)) +
                       " s are more than " + std::to_string(kMostSteps) +
                       " steps of gauge_drift; give a larger knot_every_s");
    }
    span.steps = static_cast<int>(steps);
    walks_V_[log].assign(span.steps * gauges_, 0.0);
  }
}

double ReadingTerms::walk_step_std_V(int log) const {
  return walk_->std_V_per_sqrt_h * std::sqrt(Step_s(log) / kSecondsPerHour);
}

std::vector<ReadingTerm> ReadingTerms::Of(const CalibrationFrame& frame,
                                          int gauge) {
  std::vector<ReadingTerm> terms = {{offset_V(gauge, frame.log), 1}};
  if (temperature_ && std::isfinite(frame.temperature_C)) {
    terms.push_back({temperature_coefficient_V_per_C(gauge),
                     frame.temperature_C - reference_C_});
  }
  if (frame.IsBench()) return terms;
  const Span& span = spans_[frame.log];
  if (rate_) {
    const double from = per_log_ ? span.first_s : earliest_s_;
    terms.push_back(
        {drift_V_per_h(gauge), (frame.time_s - from) / kSecondsPerHour});
  }
  for (int step = 0; step < span.steps; ++step) {
    const double passed =
        (frame.time_s - span.first_s) / Step_s(frame.log) - step;
    if (passed <= 0) break;
    terms.push_back(
        {walk_step_V(gauge, frame.log, step), std::min(passed, 1.0)});
  }
  return terms;
}

double ReadingTerms::Sum(const CalibrationFrame& frame, int gauge) {
  double sum = 0;
  for (const ReadingTerm& term : Of(frame, gauge)) {
    sum += term.coefficient * *term.variable;
  }
  return sum;
}

}  // namespace finray
