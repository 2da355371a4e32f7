#ifndef FINRAY_BENCHMARK_RUN_COMPARISON_H_
#define FINRAY_BENCHMARK_RUN_COMPARISON_H_

#include <cmath>
#include <string>
#include <vector>

#include "finray/benchmark/benchmark_run.h"
#include "finray/benchmark/statistics.h"

namespace finray {

// One setting in two runs. Times are those over the yardstick's beside them;
// the ratio b / a of their lower quartiles has an interval by the bootstrap
// over rounds. With a band of +- `band` about 1,
//
//   slower     all of the interval is above 1 + band
//   faster     all of it is below 1 / (1 + band)
//   same       all of it is inside
//   undecided  it is not told: more rounds or a quieter machine

enum class SpeedVerdict { kFaster, kSlower, kSame, kUndecided };
const char* SpeedVerdictName(SpeedVerdict verdict);

SpeedVerdict JudgeSpeed(const Interval& ratio, double band);

struct SettingComparison {
  std::string id;
  double ratio;
  Interval interval{std::nan(""), std::nan("")};  ///< NaN: too few rounds.
  SpeedVerdict speed;
  /// Errors in b above 1.5 times those of a and above rounding, or fewer frames
  /// solved, in words; empty if it is as accurate.
  std::string worse;
};

struct BenchmarkComparison {
  std::vector<SettingComparison> settings;  ///< In both runs, without peers.
  std::vector<std::string> only_a, only_b;
  /// Other machine, build, finger or depth: what makes the runs differ.
  std::vector<std::string> differences;

  int Count(SpeedVerdict verdict) const;
  int CountWorse() const;
  /// Nothing slower, nothing less accurate.
  bool passes() const {
    return Count(SpeedVerdict::kSlower) == 0 && CountWorse() == 0;
  }
};

/// `most_slowdown` is the band, 0.15 for 15 %.
BenchmarkComparison CompareRuns(const BenchmarkRun& a, const BenchmarkRun& b,
                                double most_slowdown);

}  // namespace finray

#endif  // FINRAY_BENCHMARK_RUN_COMPARISON_H_
