#include "finray/benchmark/scaling.h"

#include <algorithm>
#include <chrono>

#include "finray/batch/batch_estimation.h"

namespace finray {
namespace {

double Seconds() {
  return std::chrono::duration<double>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

}  // namespace

Scaling MeasureBatches(const BenchmarkCase& one_contact, int most_frames,
                       int most_threads, int rounds) {
  std::vector<Measurements> log;
  while (static_cast<int>(log.size()) < most_frames) {
    for (const BenchmarkFrame& frame : one_contact.frames) {
      log.push_back(frame.readings);
    }
  }
  Scaling scaling;
  for (int frames = 64; frames < 2 * most_frames; frames *= 4) {
    scaling.frames.push_back({std::min(frames, most_frames), 1, {}});
  }
  for (int threads = 1; threads <= most_threads; ++threads) {
    scaling.threads.push_back({most_frames, threads, {}});
  }
  const auto measure = [&](BatchScaling* batch) {
    const std::vector<Measurements> readings(log.begin(),
                                             log.begin() + batch->frames);
    const double start = Seconds();
    EstimateFrames(one_contact.finger, one_contact.scene, {}, readings,
                   batch->threads);
    batch->seconds.push_back(Seconds() - start);
  };
  for (int round = 0; round < rounds; ++round) {
    for (BatchScaling& batch : scaling.frames) measure(&batch);
    for (BatchScaling& batch : scaling.threads) measure(&batch);
  }
  return scaling;
}

}  // namespace finray
