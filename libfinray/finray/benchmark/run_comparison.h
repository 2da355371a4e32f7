#ifndef FINRAY_BENCHMARK_RUN_COMPARISON_H_
#define FINRAY_BENCHMARK_RUN_COMPARISON_H_

#include <string>
#include <vector>

#include "finray/benchmark/benchmark_run.h"
#include "finray/benchmark/statistics.h"

namespace finray {

// Compares a setting in two runs, a and b. Its time is that over the yardstick
// beside it. The ratio b / a of the lower quartiles gets an interval by the
// bootstrap over rounds, and with a tolerated change of `band` a verdict:
//
//   slower     the whole interval is above 1 + band
//   faster     the whole interval is below 1 / (1 + band)
//   same       the whole interval lies between these bounds
//   undecided  the interval crosses a bound; it takes more rounds or a quieter
//              machine

enum class SpeedVerdict { kFaster, kSlower, kSame, kUndecided };
const char* SpeedVerdictName(SpeedVerdict verdict);

SpeedVerdict JudgeSpeed(const Interval& ratio, double band);

struct SettingComparison {
  std::string id;
  double ratio;
  Interval interval{kNaN, kNaN};  ///< NaN: too few rounds.
  SpeedVerdict speed;
  /// Says which errors of b are above 1.5 times those of a and above rounding,
  /// and whether b solves fewer frames. Empty if b is as accurate as a.
  std::string worse;
};

struct BenchmarkComparison {
  std::vector<SettingComparison> settings;  ///< Of both runs, without peers.
  std::vector<std::string> only_a, only_b;
  /// Differences in machine, build, finger or depth, in words.
  std::vector<std::string> differences;

  int Count(SpeedVerdict verdict) const;
  int CountWorse() const;
  /// True if no setting is slower or less accurate.
  bool passes() const {
    return Count(SpeedVerdict::kSlower) == 0 && CountWorse() == 0;
  }
};

/// Compares the settings of two runs; `band` is 0.15 for 15 %.
BenchmarkComparison CompareRuns(const BenchmarkRun& a, const BenchmarkRun& b,
                                double band);

}  // namespace finray

#endif  // FINRAY_BENCHMARK_RUN_COMPARISON_H_
