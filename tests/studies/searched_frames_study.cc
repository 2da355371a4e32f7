// Counts for callgrind: what a searched frame costs beside a followed one.
// Estimates the frames of a log whose force_N is between two limits (all frames
// without limits), or 2048 frames of the benchmark, REPEATS times (1): each
// searched alone, followed one by one, or in blocks. The benchmark's frames are
// stretches of 65, and each begins with a jump, which is searched.
//
//   build/test/tests/searched_frames_study search|live|block
//       [REPEATS [LOG.csv [LEAST_N MOST_N]]]
//
// The difference of two REPEATS, over the number of frames, leaves the start-up
// out.

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <string>

#include "finray/batch/batch_estimation.h"
#include "finray/benchmark/benchmark_case.h"
#include "finray/estimation/frame_estimator.h"
#include "finray/finger/finger_yaml.h"
#include "finray/io/frame_table.h"
#include "finray/scene/measurement_columns.h"

namespace finray {
namespace {

std::vector<Measurements> FramesOfBenchmark(const BenchmarkCase& of) {
  std::vector<Measurements> frames;
  for (std::size_t i = 0; i < 2048; ++i) {
    frames.push_back(of.frames[i % of.frames.size()].readings);
  }
  return frames;
}

std::vector<Measurements> FramesOfLog(const Finger& finger,
                                      const std::string& path, double least_N,
                                      double most_N) {
  std::vector<Measurements> frames;
  for (const Measurements& row :
       ReadMeasurements(FrameTable::Read(path), finger)) {
    if (row.force_N < least_N || row.force_N >= most_N) continue;
    frames.push_back(row);
  }
  return frames;
}

int Run(const std::string& mode, int repeats, const std::string& log,
        double least_N, double most_N) {
  const Finger finger =
      ReadFinger(FINRAY_SOURCE_DIR "/configs/fingers/paper_140mm.yaml");
  const BenchmarkCase one_contact = MakeBenchmarkCase(finger, "one_contact");
  const std::vector<Measurements> frames =
      log.empty() ? FramesOfBenchmark(one_contact)
                  : FramesOfLog(finger, log, least_N, most_N);
  FrameEstimator estimator(log.empty() ? one_contact.finger : finger,
                           one_contact.scene);
  std::vector<FrameEstimate> estimates(frames.size());
  for (int repeat = 0; repeat < repeats; ++repeat) {
    for (std::size_t i = 0; i < frames.size();) {
      if (mode == "block") {
        const std::size_t count = std::min(kBlockFrames, frames.size() - i);
        estimator.EstimateBlock(&frames[i], count, &estimates[i]);
        i += count;
        continue;
      }
      estimates[i] = mode == "live" ? estimator.Next(frames[i])
                                    : estimator.Estimate(frames[i]);
      ++i;
    }
  }
  std::size_t touched = 0, ok = 0, iterations = 0;
  for (const FrameEstimate& estimate : estimates) {
    touched += estimate.contacts > 0;
    ok += estimate.status == FrameStatus::kOk;
    iterations += estimate.iterations;
  }
  std::printf("%zu frames, %zu with a contact, %zu ok, %zu iterations\n",
              frames.size(), touched, ok, iterations);
  return 0;
}

}  // namespace
}  // namespace finray

int main(int argc, char** argv) {
  constexpr double kAny = std::numeric_limits<double>::infinity();
  const std::string mode = argc > 1 ? argv[1] : "";
  if (argc == 5 || (mode != "search" && mode != "live" && mode != "block")) {
    std::fprintf(stderr,
                 "searched_frames_study: expected search|live|block [REPEATS "
                 "[LOG.csv [LEAST_N MOST_N]]]\n");
    return 2;
  }
  return finray::Run(mode, argc > 2 ? std::atoi(argv[2]) : 1,
                     argc > 3 ? argv[3] : "",
                     argc > 5 ? std::atof(argv[4]) : -kAny,
                     argc > 5 ? std::atof(argv[5]) : kAny);
}
