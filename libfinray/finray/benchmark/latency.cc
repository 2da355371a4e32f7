#include "finray/benchmark/latency.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

#include "finray/benchmark/benchmark_case.h"
#include "finray/benchmark/statistics.h"
#include "finray/estimation/frame_estimator.h"

namespace finray {
namespace {

constexpr double kStiffer = 0.01, kRib_mm = 0.03, kGain = 0.003;
constexpr int kLimit = 50;

Latency Measure(const Finger& finger, const Scene& scene,
                const std::vector<Measurements>& log, int runs) {
  Latency latency;
  latency.iteration_limit = scene.search_iteration_limit;
  latency.contacts = scene.contacts ? std::to_string(*scene.contacts) : "auto";
  latency.frames = static_cast<int>(log.size());
  std::vector<double> times(log.size(),
                            std::numeric_limits<double>::infinity());
  for (int run = 0; run < runs; ++run) {
    FrameEstimator estimator(finger, scene);
    estimator.Prepare();
    for (std::size_t i = 0; i < log.size(); ++i) {
      const double start = ThreadSeconds();
      const FrameEstimate& estimate = estimator.Next(log[i]);
      times[i] = std::min(times[i], 1e6 * (ThreadSeconds() - start));
      if (run > 0) continue;
      latency.ended += estimate.search_ended;
      latency.ok += estimate.status == FrameStatus::kOk;
      latency.most_iterations =
          std::max(latency.most_iterations, estimate.iterations);
    }
  }
  latency.p50_us = Quantile(times, 0.5);
  latency.p99_us = Quantile(times, 0.99);
  latency.p999_us = Quantile(times, 0.999);
  latency.max_us = Quantile(times, 1);
  return latency;
}

}  // namespace

Finger SlightlyWrong(const Finger& finger) {
  Finger wrong = finger;
  wrong.front_stiffness_N_mm2 *= 1 + kStiffer;
  wrong.back_stiffness_N_mm2 *= 1 + kStiffer;
  double sign = 1;
  for (Rib& rib : wrong.ribs) {
    rib.length_mm += sign * kRib_mm;
    sign = -sign;
  }
  sign = 1;
  for (Gauge& gauge : wrong.gauges) {
    gauge.gain_V_per_rad *= 1 + sign * kGain;
    sign = -sign;
  }
  return wrong;
}

std::vector<Measurements> LatencyReadings(const Finger& truth, int frames) {
  EquilibriumSolver solver(truth, ReferenceDiscretization(truth));
  std::mt19937_64 generator(5);
  std::normal_distribution<double> normal;
  std::vector<Measurements> log;
  for (int i = 0; i < frames; ++i) {
    if (!solver.Solve({WanderingContact(truth, i)})) {
      throw std::runtime_error("latency: " + solver.Why());
    }
    Measurements readings;
    for (std::size_t j = 0; j < truth.gauges.size(); ++j) {
      const Gauge& gauge = truth.gauges[j];
      readings.gauges_V.push_back(
          gauge.Volts(solver.gauge_angle(static_cast<int>(j))) +
          gauge.noise_V * normal(generator));
    }
    log.push_back(std::move(readings));
  }
  return log;
}

std::vector<Latency> MeasureLatencies(const Finger& finger, int frames,
                                      int runs) {
  std::vector<Latency> all;
  for (const bool wrong : {false, true}) {
    const auto log =
        LatencyReadings(wrong ? SlightlyWrong(finger) : finger, frames);
    for (const std::optional<int> contacts : {std::optional<int>(1), {}}) {
      Scene scene;
      scene.contacts = contacts;
      for (const std::optional<int> limit : {std::optional<int>(), {kLimit}}) {
        scene.search_iteration_limit = limit;
        all.push_back(Measure(finger, scene, log, runs));
        all.back().finger = wrong ? "slightly wrong" : "as modelled";
      }
    }
  }
  return all;
}

}  // namespace finray
