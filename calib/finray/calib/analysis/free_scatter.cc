#include "finray/calib/analysis/free_scatter.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "finray/calib/problem/median.h"
#include "finray/io/number_text.h"

namespace finray {
bool FreeScatter::IsAbove(double noise_V) const {
  const double relative_std = 1.4 / std::sqrt(differences);
  return std_V > noise_V * (1 + std::max(0.5, kSignificant * relative_std));
}

std::vector<FreeScatter> MeasureFreeScatter(const CalibrationLogs& logs,
                                            int gauges) {
  std::vector<FreeScatter> scatter;
  for (int j = 0; j < gauges; ++j) {
    std::map<int, double> last;  // the last free reading of each log
    std::vector<double> differences;
    for (const CalibrationFrame& frame : logs.frames) {
      if (frame.contact || frame.IsBench()) continue;
      const double volts = frame.gauges_V[j];
      if (!std::isfinite(volts)) continue;
      const auto [before, is_first] = last.try_emplace(frame.log, volts);
      if (!is_first) differences.push_back(std::abs(volts - before->second));
      before->second = volts;
    }
    if (differences.size() < kLeastDifferences) continue;
    scatter.push_back({j, 1.4826 * Median(differences) / std::sqrt(2.0),
                       static_cast<int>(differences.size())});
  }
  return scatter;
}

void WarnOfFreeScatter(const std::vector<FreeScatter>& scatter,
                       const Finger& finger, std::vector<Warning>* warnings) {
  const FreeScatter* worst = nullptr;
  const auto noise_V = [&](const FreeScatter& of_gauge) {
    return finger.gauges[of_gauge.gauge].noise_V;
  };
  for (const FreeScatter& one : scatter) {
    if (one.IsAbove(noise_V(one)) &&
        (worst == nullptr ||
         one.std_V / noise_V(one) > worst->std_V / noise_V(*worst))) {
      worst = &one;
    }
  }
  if (worst == nullptr) return;
  warnings->push_back(
      {"free_scatter",
       FormatText("free readings scatter by %.2g mV (gauge %d), its noise_V "
                  "says %.2g mV",
                  1e3 * worst->std_V, worst->gauge + 1, 1e3 * noise_V(*worst)),
       FormatText("give the finger this noise_V, or the plan a gauge_std_V of "
                  "%.2g; with too small a noise good frames are rejected",
                  worst->std_V)});
}

}  // namespace finray
