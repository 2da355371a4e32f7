#ifndef FINRAY_BENCHMARK_MEASUREMENT_H_
#define FINRAY_BENCHMARK_MEASUREMENT_H_

#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "finray/benchmark/setting.h"

namespace finray {

/// Largest errors over the frames that were solved; NaN where a task has none.
struct BenchmarkErrors {
  static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  double contact_mm = kNone, normal_N = kNone, normal_percent = kNone,
         tip_mm = kNone, gauges_rad = kNone;

  /// Takes up a frame. False, and nothing is taken up, if the answer has
  /// another number of contacts.
  bool Add(const FrameAnswer& answer, const FrameAnswer& truth, bool is_load);
};

/// What a setting came to.
struct Measurement {
  SettingName name;
  std::string words, family;
  int links = 0;
  std::string scheme;  ///< Of the ladder, for --scheme; empty for others.
  int resolution = 0;
  BenchmarkErrors errors;
  double solved_percent = 0;
  double iterations = 0;  ///< Mean a frame.
  int unknowns = 0;
  int frames = 0;  ///< Measured in each round.
  /// A round each: CPU time a frame, and that of the yardstick beside it.
  std::vector<double> time_us, yardstick_us;
  /// The slowest hundredth of frames that are timed one by one takes longer;
  /// by the clock.
  double slow_frame_us = BenchmarkErrors::kNone;
  /// Calls of malloc and its like, and bytes asked for; NaN if not counted.
  double allocations = BenchmarkErrors::kNone, bytes = BenchmarkErrors::kNone;
  double setup_bytes = BenchmarkErrors::kNone;

  double median_us() const;
  /// time_us over yardstick_us, round by round.
  std::vector<double> ratios() const;
  /// Their lower quartile: what settings and runs are compared by. Others on
  /// the machine disturb some rounds and only ever lengthen them; of two runs
  /// it differs half as much as the median.
  static constexpr double kUndisturbed = 0.25;
  double ratio() const;
  /// The error that the scene is about: l_c if it is found, else gauges.
  double error() const;
  const char* error_unit() const;
};

/// Calls and bytes so far, where the program counts them.
struct AllocationCount {
  double calls, bytes;
};

struct MeasuringOptions {
  int rounds = 15;
  std::function<AllocationCount()> allocations;  ///< May be empty.
  std::function<void(int done, int all)> progress;
};

/// Measures all settings round by round, in a different order every time, so
/// that a slow drift of the machine hits all alike. Cases must hold every scene
/// of the grid.
std::vector<Measurement> MeasureSettings(
    const std::vector<BenchmarkSetting>& grid,
    const std::vector<BenchmarkCase>& cases, const MeasuringOptions& options);

}  // namespace finray

#endif  // FINRAY_BENCHMARK_MEASUREMENT_H_
