#ifndef FINRAY_TESTS_STUDIES_PAIR_LOG_H_
#define FINRAY_TESTS_STUDIES_PAIR_LOG_H_

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>
#include <vector>

#include "finray/estimation/frame_estimator.h"
#include "finray/scene/clean_readings.h"
#include "studies/gauge_frames.h"

namespace finray {

using PairOfContacts = std::vector<PointContact>;

/// Two contacts that wander, sampled at 100 Hz.
inline PairOfContacts WanderingPair(int frame) {
  const double t = 0.01 * frame;
  return {{50 + 14 * std::sin(0.7 * t), 3 + 2 * std::sin(1.7 * t), 0},
          {95 + 14 * std::sin(1.1 * t + 1), 3 + 2 * std::sin(1.3 * t + 2), 0}};
}

struct PairLog {
  std::vector<PairOfContacts> truth;
  std::vector<Measurements> rows;
};

/// The plant's mesh is another than the estimator's.
template <class At>
PairLog SimulatePairs(const Finger& finger, int frames, const At& at) {
  EquilibriumSolver solver(finger, {Scheme::kTaylor8, 3});
  std::mt19937_64 generator(11);
  PairLog log;
  for (int i = 0; i < frames; ++i) {
    log.truth.push_back(at(i));
    if (!solver.Solve(log.truth.back())) throw std::runtime_error("unsolved");
    log.rows.push_back(WithNoise(CleanReadings(solver), finger, &generator));
  }
  return log;
}

inline Finger WithLittleNoise(Finger finger) {
  for (Gauge& gauge : finger.gauges) gauge.noise_V = 1e-4;
  return finger;
}

inline Scene SceneOfTwo() {
  Scene scene;
  scene.contacts = 2;
  return scene;
}

struct PairAgreement {
  int ok = 0, other_status = 0, untrue = 0;
  double farthest_std = 0;
};

inline std::vector<FrameEstimate> EstimateInBlocks(FrameEstimator* estimator,
                                                   const PairLog& log) {
  constexpr std::size_t kBlock = 64;
  std::vector<FrameEstimate> estimates(log.rows.size());
  for (std::size_t i = 0; i < log.rows.size(); i += kBlock) {
    estimator->EstimateBlock(
        &log.rows[i], std::min(kBlock, log.rows.size() - i), &estimates[i]);
  }
  return estimates;
}

/// Frames in blocks of 64 against frames that are searched alone.
inline PairAgreement ComparePairs(const Finger& finger, const Scene& scene,
                                  const PairLog& log) {
  FrameEstimator blocks(finger, scene), alone(finger, scene);
  const std::vector<FrameEstimate> estimates = EstimateInBlocks(&blocks, log);
  PairAgreement found;
  for (std::size_t i = 0; i < log.rows.size(); ++i) {
    const FrameEstimate& one = estimates[i];
    const FrameEstimate other = alone.Estimate(log.rows[i]);
    found.other_status +=
        one.status != other.status || one.contacts != other.contacts;
    if (one.status != FrameStatus::kOk || one.contacts != 2) continue;
    ++found.ok;
    for (int c = 0; c < 2; ++c) {
      const ContactEstimate& e = one.contact[c];
      const double off = std::abs(e.arc_mm - log.truth[i][c].arc_mm);
      found.untrue += off > 5 * e.arc_std_mm;
      if (other.status != FrameStatus::kOk) continue;
      found.farthest_std = std::max(
          {found.farthest_std,
           std::abs(e.arc_mm - other.contact[c].arc_mm) / e.arc_std_mm,
           std::abs(e.normal_N - other.contact[c].normal_N) / e.normal_std_N});
    }
  }
  std::printf("%d ok, %d of another status, %d untrue, farthest %.1e std\n",
              found.ok, found.other_status, found.untrue, found.farthest_std);
  return found;
}

}  // namespace finray

#endif  // FINRAY_TESTS_STUDIES_PAIR_LOG_H_
