#ifndef FINRAY_BENCHMARK_MEASUREMENT_H_
#define FINRAY_BENCHMARK_MEASUREMENT_H_

#include <functional>
#include <string>
#include <vector>

#include "finray/benchmark/setting.h"
#include "finray/io/nan.h"

namespace finray {

/// Largest errors over the solved frames. An error that a task does not have is
/// NaN.
struct BenchmarkErrors {
  double contact_mm = kNaN, normal_N = kNaN, normal_percent = kNaN,
         tip_mm = kNaN, gauges_rad = kNaN;

  /// Sums over the contacts that were found, for the rms.
  double contact_squares_mm2 = 0, normal_squares_N2 = 0;
  int contacts = 0;

  /// Rms of the errors of l_c and f_c; NaN without a contact.
  double contact_rms_mm() const;
  double normal_rms_N() const;

  /// Adds a frame. `is_load`: the contacts were given, so they have no error.
  /// Returns false and adds nothing if the answer has another number of
  /// contacts than the truth.
  bool Add(const FrameAnswer& answer, const FrameAnswer& truth, bool is_load);
};

/// The errors by which settings are compared, with their names in messages.
struct ComparedError {
  const char* name;
  double BenchmarkErrors::*value;
};
inline constexpr ComparedError kComparedErrors[] = {
    {"contact_mm", &BenchmarkErrors::contact_mm},
    {"normal_N", &BenchmarkErrors::normal_N},
    {"tip_mm", &BenchmarkErrors::tip_mm},
    {"gauges_rad", &BenchmarkErrors::gauges_rad}};

/// The results of a setting.
struct Measurement : SettingLabel {
  BenchmarkErrors errors;
  double solved_percent = 0;
  double iterations = 0;  ///< Mean of a frame.
  int unknowns = 0;
  int frames = 0;  ///< Frames of each round.
  /// CPU time of a frame and of the yardstick beside it, one of each a round.
  std::vector<double> time_us, yardstick_us;
  /// The 99 % quantile of the time of single frames, by the clock.
  double slow_frame_us = kNaN;
  /// Calls of malloc and its like, and bytes asked for; NaN if not counted.
  double allocations = kNaN, bytes = kNaN, setup_bytes = kNaN;

  double median_us() const;
  /// Returns time_us over yardstick_us, round by round.
  std::vector<double> ratios() const;
  /// Returns the kUndisturbed quantile of the ratios, by which settings and
  /// runs are compared. Other processes can only lengthen a round, so this
  /// quantile differs half as much between two runs as the median does.
  double ratio() const;
  static constexpr double kUndisturbed = 0.25;
  /// Returns the error that the scene is about: that of l_c where it is found,
  /// else that of the gauges. It is kLeastError or more, as the reference is no
  /// better.
  double error() const;
  static constexpr double kLeastError = 1e-11;  ///< mm or rad
};

/// Calls and bytes so far, if the program counts them.
struct AllocationCount {
  double calls, bytes;
};

struct MeasuringOptions {
  int rounds = 15;
  std::function<AllocationCount()> allocations;  ///< May be empty.
  /// Called rounds + 1 times for each setting; may be empty.
  std::function<void()> progress;
};

/// Measures all settings round by round, in another order each time, so that a
/// slow drift of the machine disturbs all of them alike. `cases` must hold
/// every scene of the grid.
std::vector<Measurement> MeasureSettings(
    const std::vector<BenchmarkSetting>& grid,
    const std::vector<BenchmarkCase>& cases, const MeasuringOptions& options);

/// Time of a whole batch of frames, tables of the finger included.
struct BatchScaling {
  int frames, threads;
  std::vector<double> seconds;  ///< By the clock, one a round.
};

struct Scaling {
  std::vector<BatchScaling> frames;   ///< On one thread.
  std::vector<BatchScaling> threads;  ///< With the most frames.
};

/// Times EstimateFrames on the case with one contact, repeated until there are
/// enough frames. Each round measures all sizes and all thread counts.
Scaling MeasureBatches(const BenchmarkCase& one_contact, int most_frames,
                       int most_threads, int rounds);

}  // namespace finray

#endif  // FINRAY_BENCHMARK_MEASUREMENT_H_
