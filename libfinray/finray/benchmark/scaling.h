#ifndef FINRAY_BENCHMARK_SCALING_H_
#define FINRAY_BENCHMARK_SCALING_H_

#include <vector>

#include "finray/benchmark/benchmark_case.h"

namespace finray {

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

#endif  // FINRAY_BENCHMARK_SCALING_H_
