#include "finray/scene/gauge_faults.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "finray/io/number_text.h"

namespace finray {
namespace {

// With steps below this share of its noise a gauge does not repeat a reading.
constexpr double kLeastStep = GaugeStandstill::kNoNoise;
// So many readings tell the step of a converter.
constexpr std::size_t kMostForStep = 512;

std::string GaugeWords(int gauge) {
  return "gauge " + std::to_string(gauge + 1);
}

std::string RowsInWords(std::size_t first, std::size_t last) {
  return "from row " + std::to_string(first) + " to " + std::to_string(last);
}

}  // namespace

GaugeFaultFinder::Range::Range()
    : low(std::numeric_limits<double>::infinity()), high(-low) {}

void GaugeFaultFinder::Range::Add(double volts) {
  if (!std::isfinite(volts)) return;
  low = std::min(low, volts);
  high = std::max(high, volts);
  ++readings;
}

void GaugeFaultFinder::Range::Add(const Range& other) {
  low = std::min(low, other.low);
  high = std::max(high, other.high);
  readings += other.readings;
}

GaugeFaultFinder::GaugeFaultFinder(const Finger& finger)
    : standstill_(finger),
      laws_(finger.gauges),
      gauges_(finger.gauges.size()),
      all_(finger.gauges.size()) {}

void GaugeFaultFinder::Begin(double volts, std::size_t row, Same* same) {
  same->volts = volts;
  same->rows = 0;
  same->first = row;
  same->all.clear();
}

void GaugeFaultFinder::AddTo(std::size_t row,
                             const std::vector<double>& readings_V,
                             Same* same) const {
  ++same->rows;
  same->last = row;
  same->all.resize(gauges_.size());
  for (std::size_t k = 0; k < gauges_.size(); ++k) {
    same->all[k].Add(readings_V[k]);
  }
}

void GaugeFaultFinder::AddToExtreme(double sign, double volts, std::size_t row,
                                    const std::vector<double>& readings_V,
                                    Extreme* extreme) const {
  Same& at = extreme->at;
  if (at.rows == 0 || sign * volts > sign * at.volts) {
    extreme->next_V = at.volts;
    extreme->next_rows = at.rows;
    Begin(volts, row, &at);
  }
  if (volts == at.volts) {
    AddTo(row, readings_V, &at);
  } else if (extreme->next_rows == 0 || sign * volts > sign * extreme->next_V) {
    extreme->next_V = volts;
    extreme->next_rows = 1;
  } else if (volts == extreme->next_V) {
    ++extreme->next_rows;
  }
}

void GaugeFaultFinder::Add(std::size_t row, const Measurements& readings) {
  std::vector<double>& readings_V = measured_V_;
  readings_V = readings.gauges_V;
  for (std::size_t j = 0; j < gauges_.size(); ++j) {
    if (!laws_[j].IsMeasured(readings_V[j])) {
      readings_V[j] = std::numeric_limits<double>::quiet_NaN();
    }
  }
  standstill_.Add(row, readings_V, readings.Force().magnitude_N,
                  readings.gauge_readings);
  for (std::size_t j = 0; j < gauges_.size(); ++j) {
    const double volts = readings_V[j];
    if (!std::isfinite(volts)) continue;
    Series& series = gauges_[j];
    if (series.run.rows == 0 || volts != series.run.volts) {
      Begin(volts, row, &series.run);
    }
    AddTo(row, readings_V, &series.run);
    // A longer one in which the others rest tells nothing.
    const auto told = [&](const Same& same) {
      const double moved = MovedBy(same.all, static_cast<int>(j), 0);
      return std::pair(moved > kMoves, moved > kNoiseRange ? same.rows : 0);
    };
    if (series.run.rows >= kStillRows &&
        told(series.run) > told(series.longest)) {
      series.longest = series.run;
    }
    AddToExtreme(-1, volts, row, readings_V, &series.least);
    AddToExtreme(1, volts, row, readings_V, &series.greatest);
    // A rest at the begin tells no step.
    if (series.some_V.size() < kMostForStep &&
        (series.some_V.empty() || volts != series.some_V.back())) {
      series.some_V.push_back(volts);
    }
    all_[j].Add(volts);
  }
  if (blocks_.empty() || blocks_.back().rows == rows_of_block_) {
    if (blocks_.size() == kMostBlocks) {
      for (std::size_t b = 0; 2 * b + 1 < blocks_.size(); ++b) {
        Block both = blocks_[2 * b];
        const Block& next = blocks_[2 * b + 1];
        both.rows += next.rows;
        both.last = next.last;
        for (std::size_t j = 0; j < all_.size(); ++j) {
          both.all[j].Add(next.all[j]);
        }
        blocks_[b] = both;
      }
      blocks_.resize(kMostBlocks / 2);
      rows_of_block_ *= 2;
    }
    if (blocks_.empty() || blocks_.back().rows == rows_of_block_) {
      blocks_.push_back({0, row, row, std::vector<Range>(all_.size())});
    }
  }
  Block& block = blocks_.back();
  ++block.rows;
  block.last = row;
  for (std::size_t j = 0; j < all_.size(); ++j) {
    block.all[j].Add(readings_V[j]);
  }
  ++rows_;
}

// The most that another gauge moves, in its noise or in steps of this one.
double GaugeFaultFinder::MovedBy(const std::vector<Range>& all, int gauge,
                                 double step_V) const {
  double most = 0;
  for (std::size_t k = 0; k < all.size(); ++k) {
    if (static_cast<int>(k) == gauge) continue;
    most = std::max(most, all[k].width() / std::max(laws_[k].noise_V, step_V));
  }
  return most;
}

std::optional<double> GaugeFaultFinder::StepOfGauge(int gauge) const {
  return StepOf(gauges_[gauge].some_V, 0.5 * laws_[gauge].noise_V);
}

std::optional<GaugeFault> GaugeFaultFinder::Still(int gauge,
                                                  double step_V) const {
  const Same& same = gauges_[gauge].longest;
  // A coarse gauge is still for many rows that hardly bend it.
  const bool fine = step_V < laws_[gauge].noise_V ||
                    all_[gauge].width() > 20 * step_V ||
                    all_[gauge].width() == 0;
  if (same.rows < kStillRows || !fine) return {};
  const double moved = MovedBy(same.all, gauge, step_V);
  const bool frozen = moved > kNoiseRange && step_V == 0 &&
                      standstill_.IsFrozen(gauge, same.first);
  if (moved < kMoves && !frozen) return {};
  return GaugeFault{
      GaugeFault::Kind::kStill, gauge, 0,
      GaugeWords(gauge) + FormatText(" is stuck at %.6g V ", same.volts) +
          RowsInWords(same.first, same.last) + " while the others move"};
}

std::optional<GaugeFault> GaugeFaultFinder::StillInBlocks(int gauge) const {
  const auto still = [&](const std::vector<Range>& all, std::size_t rows) {
    if (all[gauge].width() > kNoiseRange * laws_[gauge].noise_V ||
        2 * all[gauge].readings < rows) {
      return false;
    }
    for (std::size_t k = 0; k < all.size(); ++k) {
      if (static_cast<int>(k) == gauge) continue;
      if (all[k].width() < 0.5 * all_[k].width() ||
          all[k].width() < kMoves * laws_[k].noise_V) {
        return false;
      }
    }
    return all.size() > 1;
  };
  if (rows_ < static_cast<std::size_t>(kStillRows)) return {};
  if (still(all_, rows_)) {
    return GaugeFault{
        GaugeFault::Kind::kStill, gauge, 0,
        GaugeWords(gauge) + " is dead: it does not move while the others do"};
  }
  // The longest such stretch at the begin or the end of the log. Between them
  // some stretch of a log may always hardly bend a gauge.
  std::size_t first = 0, count = 0;
  for (const bool from_end : {false, true}) {
    std::vector<Range> all(all_.size());
    std::size_t rows = 0;
    for (std::size_t n = 1; n < blocks_.size(); ++n) {
      const std::size_t b = from_end ? blocks_.size() - n : n - 1;
      rows += blocks_[b].rows;
      for (std::size_t j = 0; j < all.size(); ++j) {
        all[j].Add(blocks_[b].all[j]);
      }
      if (all[gauge].width() > kNoiseRange * laws_[gauge].noise_V) break;
      if (n > count && still(all, rows)) {
        first = from_end ? b : 0;
        count = n;
      }
    }
  }
  if (count < static_cast<std::size_t>(kStillBlocks) ||
      count * rows_of_block_ < static_cast<std::size_t>(kStillRows) ||
      all_[gauge].width() < 2 * kMoves * laws_[gauge].noise_V) {
    return {};
  }
  return GaugeFault{
      GaugeFault::Kind::kStill, gauge, 0,
      GaugeWords(gauge) + " is dead " +
          RowsInWords(blocks_[first].first, blocks_[first + count - 1].last) +
          ": it does not move while the others do"};
}

std::optional<GaugeFault> GaugeFaultFinder::Clipped(int gauge,
                                                    double step_V) const {
  if (all_[gauge].width() < kMoves * laws_[gauge].noise_V ||
      step_V > kCoarseStep * laws_[gauge].noise_V) {
    return {};
  }
  const Series& series = gauges_[gauge];
  for (const Extreme* extreme : {&series.greatest, &series.least}) {
    const Same* same = &extreme->at;
    if (same->rows < kClippedRows ||
        static_cast<double>(same->rows) <=
            kPiledUp * static_cast<double>(extreme->next_rows) ||
        MovedBy(same->all, gauge, step_V) < kMoves) {
      continue;
    }
    return GaugeFault{
        GaugeFault::Kind::kClipped, gauge, 0,
        GaugeWords(gauge) + " is clipped: " + std::to_string(same->rows) +
            FormatText(" readings are exactly %.6g V, its %s, ", same->volts,
                       extreme == &series.least ? "least" : "greatest") +
            RowsInWords(same->first, same->last) + ", while the others move"};
  }
  return {};
}

std::optional<GaugeFault> GaugeFaultFinder::AllStill() const {
  std::string words = standstill_.StillWords();
  // Coarse gauges repeat themselves.
  for (int j = 0; words.empty() && j < static_cast<int>(gauges_.size()); ++j) {
    if (all_[j].width() > 0 &&
        !StepOf(gauges_[j].some_V, kLeastStep * laws_[j].noise_V)) {
      words = standstill_.FrozenWords();
    }
  }
  if (words.empty()) return {};
  return GaugeFault{GaugeFault::Kind::kAllStill, 0, 0, std::move(words)};
}

std::vector<GaugeFault> GaugeFaultFinder::Faults() const {
  std::vector<GaugeFault> faults;
  if (std::optional<GaugeFault> all = AllStill()) {
    faults.push_back(std::move(*all));
    return faults;
  }
  for (int j = 0; j < static_cast<int>(gauges_.size()); ++j) {
    const std::optional<double> step = StepOfGauge(j);
    std::optional<GaugeFault> fault = Still(j, step.value_or(0));
    if (!fault) fault = StillInBlocks(j);
    if (!fault) fault = Clipped(j, step.value_or(0));
    if (!fault && step && *step > kCoarseStep * laws_[j].noise_V) {
      fault = GaugeFault{
          GaugeFault::Kind::kCoarse, j, *step,
          GaugeWords(j) + FormatText(" has steps of %.3g mV, %.2g times its "
                                     "noise_V",
                                     1e3 * *step, *step / laws_[j].noise_V)};
    }
    if (fault) faults.push_back(std::move(*fault));
  }
  return faults;
}

std::string WordsOf(const std::vector<GaugeFault>& faults, bool steps) {
  std::string words;
  for (const GaugeFault& fault : faults) {
    if ((fault.kind == GaugeFault::Kind::kCoarse) != steps) continue;
    words += (words.empty() ? "" : ", ") + fault.words;
  }
  return words;
}

std::optional<double> StepOf(std::vector<double> readings_V, double least) {
  std::sort(readings_V.begin(), readings_V.end());
  double step = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < readings_V.size(); ++i) {
    const double gap = readings_V[i] - readings_V[i - 1];
    if (gap > 1e-3 * least) step = std::min(step, gap);
  }
  if (!std::isfinite(step) || step < least) return {};
  // Fewer values are multiples of something by chance.
  readings_V.erase(std::unique(readings_V.begin(), readings_V.end()),
                   readings_V.end());
  if (readings_V.size() < 5) return {};
  // The whole range tells the step better than one of its gaps.
  const double range = readings_V.back() - readings_V.front();
  step = range / std::round(range / step);
  for (const double volts : readings_V) {
    const double steps = (volts - readings_V.front()) / step;
    if (std::abs(steps - std::round(steps)) > 0.02) return {};
  }
  return step;
}

}  // namespace finray
