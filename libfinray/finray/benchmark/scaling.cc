#include "finray/benchmark/scaling.h"

#include <chrono>
#include <cmath>

#include "finray/batch/batch_estimation.h"
#include "finray/benchmark/statistics.h"

namespace finray {
namespace {

double Seconds() {
  return std::chrono::duration<double>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

}  // namespace

std::vector<LinkScaling> ScalingWithLinks(const std::vector<Measurement>& all) {
  constexpr double kLeastLinks = 50;
  std::vector<LinkScaling> found;
  for (const char* task : {"forward", "sensing"}) {
    for (const char* family : {"paper", "chain"}) {
      LinkScaling one;
      one.solver = std::string(task) + " " + family;
      std::vector<double> links, time_us;
      for (const Measurement& m : all) {
        if (m.name.task != task || m.family != family ||
            m.name.scene != "one_contact") {
          continue;
        }
        one.links.push_back(m.links);
        one.time_us.push_back(m.median_us());
        if (m.links >= kLeastLinks) {
          links.push_back(m.links);
          time_us.push_back(m.median_us());
        }
      }
      if (links.size() < 2) continue;
      one.exponent = LogLogSlope(links, time_us);
      found.push_back(one);
    }
  }
  return found;
}

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
