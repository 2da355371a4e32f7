#include "finray/calib/analysis/gauge_plausibility.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "finray/calib/analysis/unsupported.h"
#include "finray/calib/problem/median.h"
#include "finray/io/error.h"
#include "finray/io/number_text.h"
#include "finray/scene/frame_columns.h"

namespace finray {
namespace {

// Sums over frames of one reading against one expected angle, both about their
// means in each log.
struct Regression {
  double vv = 0, va = 0, aa = 0;
  std::size_t frames = 0;
  double slope() const { return aa > 0 ? va / aa : 0; }
  double correlation() const {
    return vv > 0 && aa > 0 ? va / std::sqrt(vv * aa) : 0;
  }
  // The part of the reading's variance that the angle does not explain.
  double rest() const { return 1 - correlation() * correlation(); }
};

Regression Regress(const std::vector<ExpectedGauges>& frames, int reading,
                   int angle) {
  struct Means {
    double v = 0, a = 0;
    int n = 0;
  };
  std::map<int, Means> logs;
  for (const ExpectedGauges& frame : frames) {
    if (!std::isfinite(frame.read_V[reading])) continue;
    Means& log = logs[frame.log];
    ++log.n;
    log.v += (frame.read_V[reading] - log.v) / log.n;
    log.a += (frame.expected_rad[angle] - log.a) / log.n;
  }
  Regression sums;
  for (const ExpectedGauges& frame : frames) {
    if (!std::isfinite(frame.read_V[reading])) continue;
    const Means& log = logs[frame.log];
    const double v = frame.read_V[reading] - log.v;
    const double a = frame.expected_rad[angle] - log.a;
    sums.vv += v * v;
    sums.va += v * a;
    sums.aa += a * a;
    ++sums.frames;
  }
  return sums;
}

// Returns the gauge whose angle the reading fits, itself unless another one
// fits far better.
int LooksLike(const std::vector<ExpectedGauges>& frames, int reading,
              double own_rest, int gauges) {
  constexpr double kFits = 0.1;  // of the variance is left at most
  int like = reading;
  double least = std::min(own_rest / (kSwapped * kSwapped), kFits);
  for (int k = 0; k < gauges; ++k) {
    if (k == reading) continue;
    const double rest = Regress(frames, reading, k).rest();
    if (rest < least) {
      like = k;
      least = rest;
    }
  }
  return like;
}

bool HardlyBends(const Regression& sums) {
  return sums.aa < kLeastBend * kLeastBend * static_cast<double>(sums.frames);
}

}  // namespace

double UnexplainedShare(const std::vector<ExpectedGauges>& frames,
                        const Finger& finger) {
  double sum = 0;
  int count = 0;
  for (int j = 0; j < static_cast<int>(finger.gauges.size()); ++j) {
    const Regression sums = Regress(frames, j, j);
    if (sums.frames < kLeastFrames || HardlyBends(sums)) continue;
    sum += sums.rest();
    ++count;
  }
  return sum / count;
}

void RefuseImplausibleGauges(const std::vector<ExpectedGauges>& frames,
                             const Finger& finger) {
  const auto gauges = static_cast<int>(finger.gauges.size());
  std::map<int, Regression> own;
  std::vector<double> ratios;
  bool unexpected = false;
  const auto ratio = [&](int j) {
    return own.at(j).slope() / finger.gauges[j].gain_V_per_rad;
  };
  for (int j = 0; j < gauges; ++j) {
    const Regression sums = Regress(frames, j, j);
    const auto count = static_cast<double>(sums.frames);
    if (sums.frames < kLeastFrames) continue;
    if (HardlyBends(sums)) {
      unexpected |=
          std::sqrt(sums.vv / count) > kUnexpected * finger.gauges[j].noise_V;
      continue;
    }
    own[j] = sums;
    ratios.push_back(std::abs(ratio(j)));
  }
  if (ratios.empty() && unexpected) {
    throw InputError(
        "logs: gauges respond, but objects or contacts where the logs have "
        "them hardly bend the finger: are object_x_mm and object_y_mm "
        "swapped?");
  }
  if (ratios.empty()) return;
  // First, because a swapped gauge may seem dead or of the wrong sign.
  std::string swapped;
  int others = 0;
  for (const auto& [j, sums] : own) {
    const int like = LooksLike(frames, j, sums.rest(), gauges);
    if (like == j) continue;
    ++others;
    swapped += (swapped.empty() ? "" : ", ") + GaugeVolts(j) +
               " bends as gauge " + std::to_string(like + 1) + " should";
  }
  if (others >= 2) {
    throw InputError("logs: gauges seem to be swapped: " + swapped +
                     "; check the order of the columns, or the start_mm of "
                     "the finger's gauges");
  }
  const double usual = Median(ratios);
  for (const auto& [j, sums] : own) {
    if (std::abs(ratio(j)) > kDeadShare * usual) continue;
    throw InputError("logs: " + GaugeVolts(j) +
                     " does not respond to the load: check its wiring and "
                     "column; a finger without this gauge can be calibrated");
  }
  if (usual > kMostGain) {
    throw InputError(FormatText(
        "logs: gauges respond %.0f times as much as gain_V_per_rad of the "
        "finger says: expected readings in V; are these mV or counts?",
        usual));
  }
  for (const auto& [j, sums] : own) {
    const double correlation =
        std::copysign(sums.correlation(),
                      sums.correlation() * finger.gauges[j].gain_V_per_rad);
    if (correlation > kWrongSign) continue;
    throw InputError(
        "logs: " + GaugeVolts(j) +
        FormatText(" falls where the finger's gain says that it rises "
                   "(correlation %.2f): swap its wires, or change the sign of "
                   "its gain_V_per_rad",
                   correlation));
  }
}

}  // namespace finray
