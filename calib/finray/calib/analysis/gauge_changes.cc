#include "finray/calib/analysis/gauge_changes.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "finray/io/error.h"
#include "finray/io/number_text.h"
#include "finray/scene/frame_columns.h"
#include "finray/scene/gauge_faults.h"

namespace finray {
namespace {

using Frames = std::vector<const ExpectedGauges*>;

// A line through readings over angles, in frames first <= i < end.
struct Line {
  int count = 0;
  double v = 0, a = 0;  // means
  double vv = 0, va = 0, aa = 0;
  double lowest = std::numeric_limits<double>::infinity();
  double highest = -std::numeric_limits<double>::infinity();

  double slope() const { return aa > 0 ? va / aa : 0; }
  double rest() const { return aa > 0 ? std::max(0.0, vv - va * va / aa) : vv; }
  double range() const { return highest - lowest; }
  bool enough() const { return count >= static_cast<int>(kLeastFrames); }
  bool bends() const { return aa > kLeastBend * kLeastBend * count; }
};

Line LineOf(const Frames& frames, std::size_t first, std::size_t end,
            int reading, int angle) {
  Line line;
  for (std::size_t i = first; i < end; ++i) {
    const double v = frames[i]->read_V[reading];
    if (!std::isfinite(v)) continue;
    const double a = frames[i]->expected_rad[angle];
    ++line.count;
    const double off_v = v - line.v, off_a = a - line.a;
    line.v += off_v / line.count;
    line.a += off_a / line.count;
    line.vv += off_v * (v - line.v);
    line.va += off_v * (a - line.a);
    line.aa += off_a * (a - line.a);
    line.lowest = std::min(line.lowest, v);
    line.highest = std::max(line.highest, v);
  }
  return line;
}

class ChangesOfLog {
 public:
  ChangesOfLog(Frames frames, std::string log, const Finger& finger)
      : frames_(std::move(frames)),
        log_(std::move(log)),
        finger_(finger),
        gauges_(static_cast<int>(finger.gauges.size())) {}

  void Refuse() const {
    if (frames_.size() < 2 * kLeastFrames) return;
    RefuseJumps();
    RefuseExchanges();
    RefuseGainChanges();
  }

 private:
  struct Split {
    std::size_t at = 0;
    Line before, after;
    double ratio = 0;  // of S with one line to S with both
  };

  // S of some frames; no line is better than noise.
  double Sum(const Line& line, int reading) const {
    return line.rest() +
           line.count * std::pow(finger_.gauges[reading].noise_V, 2);
  }

  Split BestSplit(int reading) const {
    Split best;
    const double one =
        Sum(LineOf(frames_, 0, frames_.size(), reading, reading), reading);
    for (std::size_t k = kLeastFrames; k + kLeastFrames <= frames_.size();
         ++k) {
      const Line before = LineOf(frames_, 0, k, reading, reading);
      const Line after = LineOf(frames_, k, frames_.size(), reading, reading);
      if (!before.enough() || !after.enough()) continue;
      const double ratio = one / (Sum(before, reading) + Sum(after, reading));
      if (ratio > best.ratio) best = {k, before, after, ratio};
    }
    return best;
  }

  // Rows count from 1. Where not all rows were looked at, the change is between
  // two of them.
  std::string Where(std::size_t at) const {
    const int last = frames_[at - 1]->row + 1, first = frames_[at]->row + 1;
    return last + 1 >= first
               ? log_ + " row " + std::to_string(first)
               : log_ + " row " + std::to_string(first) + " (or since row " +
                     std::to_string(last + 1) + ")";
  }

  // Throws for the gauges that `what` has words for, at the earliest row.
  template <class What>
  void RefuseSome(const What& what, const std::string& remedy) const {
    std::string words;
    std::size_t at = frames_.size();
    for (int j = 0; j < gauges_; ++j) {
      const Split split = BestSplit(j);
      const std::string its = what(j, split);
      if (its.empty()) continue;
      words += (words.empty() ? "" : ", ") + GaugeVolts(j) + " " + its;
      at = std::min(at, split.at);
    }
    if (words.empty()) return;
    throw InputError("logs: from " + Where(at) + " on " + words + ": " +
                     remedy);
  }

  void RefuseJumps() const {
    RefuseSome(
        [&](int, const Split& split) -> std::string {
          const double slope = split.before.aa > split.after.aa
                                   ? split.before.slope()
                                   : split.after.slope();
          const double jump = split.after.v - split.before.v -
                              slope * (split.after.a - split.before.a);
          const double range =
              std::max(split.before.range(), split.after.range());
          if (split.ratio < kJumpShare * kJumpShare || std::abs(jump) < range) {
            return "";
          }
          return FormatText("jumps by %+.3g V", jump);
        },
        "no load bends it so far; give the rows before and after as logs of "
        "their own, with gauge_offset: {per_log: true}, or record anew");
  }

  void RefuseGainChanges() const {
    RefuseSome(
        [&](int, const Split& split) -> std::string {
          const auto& [at, before, after, ratio] = split;
          const double change = after.slope() / before.slope();
          const double times = std::max(std::abs(change), 1 / std::abs(change));
          const auto fits = [](const Line& line) {
            return line.bends() && line.rest() < kLeftOver * line.vv;
          };
          // Bent alike, so that both tell a slope.
          const double bent = (before.aa / before.count) /
                              std::max(after.aa / after.count, 1e-300);
          if (ratio < kGainShare * kGainShare || !fits(before) ||
              !fits(after) || times < kGainChange || bent > 5 || bent < 0.2) {
            return "";
          }
          return FormatText("responds %.2g times as much as before", change);
        },
        "its amplifier or bridge has changed; calibrate from the rows before "
        "or "
        "from those after");
  }

  // Two readings at once, so that a gauge that only turns dead is none.
  void RefuseExchanges() const {
    for (int j = 0; j < gauges_; ++j) {
      for (int m = j + 1; m < gauges_; ++m) {
        const auto at = ExchangedAt(j, m);
        if (!at) continue;
        throw InputError(
            "logs: from " + Where(*at) + " on " + GaugeVolts(j) +
            " bends as gauge " + std::to_string(m + 1) + " should, and " +
            GaugeVolts(m) + " as gauge " + std::to_string(j + 1) +
            ": two channels change places there; exchange them, or calibrate "
            "from the rows before or from those after");
      }
    }
  }

  std::optional<std::size_t> ExchangedAt(int j, int m) const {
    const std::size_t n = frames_.size();
    const auto sum = [&](std::size_t first, std::size_t end, int reading,
                         int angle) {
      return Sum(LineOf(frames_, first, end, reading, angle), reading);
    };
    const double own = sum(0, n, j, j) + sum(0, n, m, m);
    const double others = sum(0, n, j, m) + sum(0, n, m, j);
    double least = std::min(own, others) / (kExchangeShare * kExchangeShare);
    std::optional<std::size_t> at;
    for (std::size_t k = kLeastFrames; k + kLeastFrames <= n; ++k) {
      const Line lines[] = {
          LineOf(frames_, 0, k, j, j), LineOf(frames_, 0, k, m, m),
          LineOf(frames_, k, n, j, m), LineOf(frames_, k, n, m, j)};
      if (!std::all_of(std::begin(lines), std::end(lines),
                       [](const Line& line) { return line.enough(); })) {
        continue;
      }
      const double both = Sum(lines[0], j) + Sum(lines[1], m) +
                          Sum(lines[2], j) + Sum(lines[3], m);
      if (both < least) {
        least = both;
        at = k;
      }
    }
    if (!at) return at;
    const auto fits = [&](std::size_t first, std::size_t end, int reading,
                          int angle) {
      const Line line = LineOf(frames_, first, end, reading, angle);
      return line.bends() && line.rest() < kLeftOver * line.vv;
    };
    const bool all = fits(0, *at, j, j) && fits(0, *at, m, m) &&
                     fits(*at, n, j, m) && fits(*at, n, m, j);
    return all ? at : std::nullopt;
  }

  Frames frames_;
  std::string log_;
  const Finger& finger_;
  int gauges_;
};

// A reading and its row.
using Series = std::vector<std::pair<int, double>>;

std::optional<double> StepIn(Series::const_iterator first,
                             Series::const_iterator end, double least) {
  std::vector<double> values;
  for (auto at = first; at != end; ++at) values.push_back(at->second);
  return StepOf(std::move(values), least);
}

// Returns how many readings from `first` on are multiples of the step away from
// it.
template <class Iterator>
std::size_t OnSteps(Iterator first, Iterator end, double step) {
  Iterator at = first;
  for (; at != end; ++at) {
    const double steps = (at->second - first->second) / step;
    if (std::abs(steps - std::round(steps)) > 0.02) break;
  }
  return static_cast<std::size_t>(at - first);
}

void RefuseCoarserStepsOf(const Series& series, const std::string& log,
                          int gauge, double noise_V) {
  constexpr std::size_t kLooked = 20;
  if (series.size() < 2 * kLooked) return;
  const auto looked = static_cast<std::ptrdiff_t>(kLooked);
  const double least = GaugeFaultFinder::kCoarseStep * noise_V;
  const auto before = StepIn(series.begin(), series.begin() + looked, least);
  const auto after = StepIn(series.end() - looked, series.end(), least);
  if (before.has_value() == after.has_value()) return;
  const double step = before ? *before : *after;
  const std::size_t coarse =
      before ? OnSteps(series.begin(), series.end(), step)
             : OnSteps(series.rbegin(), series.rend(), step);
  if (coarse + kLooked > series.size()) return;
  const int row = series[before ? coarse : series.size() - coarse].first + 1;
  throw InputError(
      "logs: " + GaugeVolts(gauge) +
      FormatText(
          " has steps of %.3g V %s %s row %d, and finer ones %s: did the "
          "range of its converter change? Calibrate from the rows with "
          "fine steps",
          step, before ? "before" : "from", log.c_str(), row,
          before ? "from there on" : "before"));
}

}  // namespace

void RefuseCoarserSteps(const CalibrationLogs& logs, const Finger& finger) {
  const auto gauges = static_cast<int>(finger.gauges.size());
  for (int j = 0; j < gauges; ++j) {
    std::map<int, Series> readings;
    for (const CalibrationFrame& frame : logs.frames) {
      if (frame.IsBench() || !std::isfinite(frame.gauges_V[j])) continue;
      readings[frame.log].emplace_back(frame.row, frame.gauges_V[j]);
    }
    for (const auto& [log, series] : readings) {
      RefuseCoarserStepsOf(series, logs.names[log], j,
                           finger.gauges[j].noise_V);
    }
  }
}

void RefuseGaugeChanges(const std::vector<ExpectedGauges>& frames,
                        const CalibrationLogs& logs, const Finger& finger) {
  std::map<int, Frames> by_log;
  for (const ExpectedGauges& frame : frames)
    by_log[frame.log].push_back(&frame);
  for (auto& [log, its] : by_log) {
    ChangesOfLog(std::move(its), logs.names[log], finger).Refuse();
  }
}

std::map<int, std::vector<GaugeFault>> FindGaugeFaults(
    const CalibrationLogs& logs, const Finger& finger) {
  std::map<int, GaugeFaultFinder> finders;
  for (const CalibrationFrame& frame : logs.frames) {
    if (frame.IsBench()) continue;
    const auto at = finders.try_emplace(frame.log, finger).first;
    at->second.Add(static_cast<std::size_t>(frame.row) + 1, frame);
  }
  std::map<int, std::vector<GaugeFault>> found;
  for (const auto& [log, finder] : finders) {
    std::vector<GaugeFault> faults = finder.Faults();
    if (!faults.empty()) found[log] = std::move(faults);
  }
  return found;
}

}  // namespace finray
