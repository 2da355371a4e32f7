#ifndef FINRAY_BENCHMARK_SCALING_H_
#define FINRAY_BENCHMARK_SCALING_H_

#include <string>
#include <vector>

#include "finray/benchmark/benchmark_case.h"
#include "finray/benchmark/measurement.h"

namespace finray {

/// How time grows with the number of links, time ~ n^exponent.
struct LinkScaling {
  std::string solver;  ///< "forward paper", "sensing chain", ...
  std::vector<double> links, time_us;
  double exponent;
};

/// A whole batch of frames, from finger to estimates.
struct BatchScaling {
  int frames, threads;
  std::vector<double> seconds;  ///< By the clock, a round each.
};

struct Scaling {
  std::vector<LinkScaling> links;
  std::vector<BatchScaling> frames;   ///< On one thread.
  std::vector<BatchScaling> threads;  ///< Of the most frames.
};

/// From the settings with one contact. Exponents are those of n >= 50, where
/// what does not depend on n is small.
std::vector<LinkScaling> ScalingWithLinks(const std::vector<Measurement>& all);

/// EstimateFrames of the case with one contact, repeated as often as frames are
/// wanted, in rounds: all sizes and thread counts in each.
Scaling MeasureBatches(const BenchmarkCase& one_contact, int most_frames,
                       int most_threads, int rounds);

}  // namespace finray

#endif  // FINRAY_BENCHMARK_SCALING_H_
