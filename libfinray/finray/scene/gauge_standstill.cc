#include "finray/scene/gauge_standstill.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "finray/io/number_text.h"

namespace finray {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// So few rows beside a run do not tell what a log repeats.
constexpr std::size_t kLeastOtherRows = 5;

}  // namespace

void GaugeStandstill::Runs::Add(std::size_t row, bool same) {
  ++rows;
  if (!same) {
    if (now.rows > longest.rows) {
      next = longest.rows;
      longest = now;
    } else {
      next = std::max(next, now.rows);
    }
    now = {0, row, row};
  }
  ++now.rows;
  now.last = row;
}

GaugeStandstill::Run GaugeStandstill::Runs::Frozen() const {
  const bool is_end = now.rows > longest.rows;
  const Run& run = is_end ? now : longest;
  const std::size_t others = is_end ? longest.rows : std::max(next, now.rows);
  const std::size_t least = is_end ? kStandRows : kLongRows;
  if (run.rows < std::max(least, kLonger * others) ||
      rows - run.rows < kLeastOtherRows) {
    return {};
  }
  return run;
}

GaugeStandstill::GaugeStandstill(const Finger& finger)
    : gauges_(finger.gauges),
      series_(finger.gauges.size(),
              {std::nan(""), kInfinity, -kInfinity, 0, 0, {}}),
      least_force_N_(kInfinity),
      most_force_N_(-kInfinity) {}

void GaugeStandstill::Add(std::size_t row,
                          const std::vector<double>& readings_V, double force_N,
                          double readings) {
  bool any = false, all_same = true;
  for (std::size_t j = 0; j < series_.size(); ++j) {
    const double volts = readings_V[j];
    if (!std::isfinite(volts)) continue;
    Series& series = series_[j];
    const bool same = volts == series.last_V;
    any = true;
    all_same &= same;
    if (std::isfinite(series.last_V)) {
      series.squares_V2 +=
          readings * (volts - series.last_V) * (volts - series.last_V);
      ++series.changes;
    }
    series.last_V = volts;
    series.low_V = std::min(series.low_V, volts);
    series.high_V = std::max(series.high_V, volts);
    series.runs.Add(row, same);
  }
  if (!any) return;
  all_.Add(row, all_same);
  ++rows_;
  if (!std::isfinite(force_N)) return;
  least_force_N_ = std::min(least_force_N_, force_N);
  most_force_N_ = std::max(most_force_N_, force_N);
}

std::string GaugeStandstill::StillWords() const {
  if (rows_ < kStandRows) return "";
  bool away = false, constant = true;
  std::string list;
  std::size_t read = 0;
  for (std::size_t j = 0; j < series_.size(); ++j) {
    const Series& series = series_[j];
    if (series.changes == 0) continue;
    list += (read++ > 0 ? ", " : "") + std::to_string(j + 1);
    const Gauge& gauge = gauges_[j];
    const double range_V = series.high_V - series.low_V;
    const double noise_V = kNoNoise * gauge.noise_V;
    if (range_V > kNoiseRange * gauge.noise_V ||
        series.squares_V2 >
            2 * static_cast<double>(series.changes) * noise_V * noise_V) {
      return "";
    }
    away |= std::abs(series.last_V - gauge.offset_V) > kAway * gauge.noise_V;
    constant &= range_V == 0;
  }
  const bool any_force = most_force_N_ >= least_force_N_;
  const bool touched = any_force && most_force_N_ - least_force_N_ > kTouch_N;
  const bool wrong = constant ? rows_ >= kLongRows : away;
  if (!touched && (any_force || !wrong)) return "";
  if (read > 1 && read == series_.size()) list = "1 to " + std::to_string(read);
  std::string words = read == 1 ? "gauge " + list + " does not move"
                                : "gauges " + list + " do not move";
  words += " in " + std::to_string(rows_) + " rows, not even by their noise";
  if (touched) {
    words += FormatText(", while force_N varies by %.3g N",
                        most_force_N_ - least_force_N_);
  }
  return words + ": " + kCauses;
}

std::string GaugeStandstill::FrozenWords() const {
  const Run run = all_.Frozen();
  if (run.rows == 0) return "";
  return "all gauges read the same from row " + std::to_string(run.first) +
         " to " + std::to_string(run.last) +
         ": the logger or its link has frozen";
}

bool GaugeStandstill::IsFrozen(int gauge, std::size_t first) const {
  const Run run = series_[static_cast<std::size_t>(gauge)].runs.Frozen();
  return run.rows > 0 && run.first == first;
}

}  // namespace finray
