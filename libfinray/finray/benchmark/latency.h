#ifndef FINRAY_BENCHMARK_LATENCY_H_
#define FINRAY_BENCHMARK_LATENCY_H_

#include <optional>
#include <string>
#include <vector>

#include "finray/finger/finger.h"
#include "finray/scene/measurements.h"

namespace finray {

/// How long FrameEstimator::Next takes, frame by frame.
struct Latency {
  std::string finger;                  ///< "as modelled" or "slightly wrong"
  std::string contacts;                ///< As in a scene: "1" or "auto".
  std::optional<int> iteration_limit;  ///< Scene::search_iteration_limit.
  int frames = 0;
  /// Quantiles of the CPU time of a frame, and the largest.
  double p50_us = 0, p99_us = 0, p999_us = 0, max_us = 0;
  int ok = 0;               ///< Frames with that status.
  int ended = 0;            ///< Frames whose search was ended.
  int most_iterations = 0;  ///< Of a frame.
};

/// Returns a finger that differs from `finger` as a good calibration leaves it:
/// beams 1 % stiffer, the first rib 0.03 mm longer and the others in turn
/// shorter and longer by as much, gains 0.3 % larger and smaller in turn.
Finger SlightlyWrong(const Finger& finger);

/// Returns what the gauges of `truth` read while a contact wanders over it and
/// its force swells, as in a benchmark case but without a break, with the noise
/// of the gauges. The equilibria are those of ReferenceDiscretization.
std::vector<Measurements> LatencyReadings(const Finger& truth, int frames);

/// Measures Next() over logs of a finger as modelled and of one slightly wrong,
/// with one contact and with `auto`, without and with a limit. A log is
/// estimated `runs` times, each time by a new estimator, and the least time of
/// each frame counts: other work on the machine only ever lengthens one.
std::vector<Latency> MeasureLatencies(const Finger& finger, int frames,
                                      int runs);

}  // namespace finray

#endif  // FINRAY_BENCHMARK_LATENCY_H_
