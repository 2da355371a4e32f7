#ifndef FINRAY_TESTS_STUDIES_RAMPS_H_
#define FINRAY_TESTS_STUDIES_RAMPS_H_

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include "finray/estimation/frame_estimator.h"
#include "studies/gauge_frames.h"

namespace finray {

/// An `ok` frame that is far from the truth.
struct FarFrame {
  double arc_mm, normal_N;  ///< the truth
  FrameEstimate estimate;
  std::vector<double> gauges_V;
};

/// What came of the frames of one band of places.
struct RampTally {
  double from_mm = 0, to_mm = 0;
  long frames = 0, ok = 0, two = 0;
  long beyond_3 = 0, beyond_6 = 0;  ///< `ok` frames, in std of l_c or of f_c
  double worst = 0;                 ///< of the `ok` frames, in std
  double hidden_N = 0;              ///< the largest force of a no_contact frame
  std::vector<FarFrame> far;        ///< those beyond 6 std

  void Add(const RampTally& other) {
    frames += other.frames;
    ok += other.ok;
    two += other.two;
    beyond_3 += other.beyond_3;
    beyond_6 += other.beyond_6;
    worst = std::max(worst, other.worst);
    hidden_N = std::max(hidden_N, other.hidden_N);
    far.insert(far.end(), other.far.begin(), other.far.end());
  }
};

/// The error of an estimate with one contact in std, the larger one of l_c and
/// f_c. A second contact that is not there counts as infinitely far.
inline double ErrorInStd(const FrameEstimate& estimate, double arc_mm,
                         double normal_N) {
  if (estimate.contacts != 1) return std::numeric_limits<double>::infinity();
  const ContactEstimate& found = estimate.contact[0];
  return std::max(std::abs(found.arc_mm - arc_mm) / found.arc_std_mm,
                  std::abs(found.normal_N - normal_N) / found.normal_std_N);
}

/// Ramps of the force from zero to `peak_N` and back at random places of the
/// whole beam, in blocks of 64 frames as finray_estimate reads them. Returns a
/// tally for each of the bands that `edges_mm` bounds. The result does not
/// depend on threads.
inline std::vector<RampTally> RampStudy(const Finger& finger,
                                        const Scene& scene, double peak_N,
                                        int ramps,
                                        const std::vector<double>& edges_mm,
                                        unsigned seed) {
  constexpr int kFrames = 64;
  struct Worker {
    Worker(const Finger& finger, const Scene& scene)
        : estimator(finger, scene), solver(finger, {}) {}
    FrameEstimator estimator;
    EquilibriumSolver solver;
  };
  tbb::enumerable_thread_specific<std::unique_ptr<Worker>> workers;
  std::vector<RampTally> of_ramp(ramps);
  tbb::parallel_for(0, ramps, [&](int ramp) {
    std::unique_ptr<Worker>& worker = workers.local();
    if (!worker) worker = std::make_unique<Worker>(finger, scene);
    std::seed_seq sequence{seed, static_cast<unsigned>(ramp)};
    std::mt19937_64 generator(sequence);
    std::uniform_real_distribution<double> uniform;
    const double arc =
        finger.front_length_mm * (ramp + uniform(generator)) / ramps;
    const double shift = uniform(generator);
    std::vector<double> forces;
    std::vector<Measurements> rows;
    std::vector<FrameEstimate> estimates(kFrames);
    worker->solver.Reset();
    for (int i = 0; i < kFrames; ++i) {
      const double phase = (i + shift) / kFrames;
      forces.push_back(peak_N * (1 - std::abs(2 * phase - 1)));
      worker->solver.Solve({{arc, forces.back(), 0}});
      rows.push_back(
          WithNoise(CleanReadings(worker->solver), finger, &generator));
    }
    worker->estimator.EstimateBlock(rows.data(), kFrames, estimates.data());
    RampTally& tally = of_ramp[ramp];
    tally.from_mm = arc;
    for (int i = 0; i < kFrames; ++i) {
      const FrameEstimate& estimate = estimates[i];
      ++tally.frames;
      tally.two += estimate.contacts == 2;
      if (estimate.status == FrameStatus::kNoContact) {
        tally.hidden_N = std::max(tally.hidden_N, forces[i]);
      }
      if (estimate.status != FrameStatus::kOk) continue;
      ++tally.ok;
      const double error = ErrorInStd(estimate, arc, forces[i]);
      tally.beyond_3 += error > 3;
      tally.beyond_6 += error > 6;
      tally.worst = std::max(tally.worst, error);
      if (error > 6) {
        tally.far.push_back({arc, forces[i], estimate, rows[i].gauges_V});
      }
    }
  });
  std::vector<RampTally> bands;
  for (std::size_t b = 0; b + 1 < edges_mm.size(); ++b) {
    RampTally& band = bands.emplace_back();
    for (const RampTally& tally : of_ramp) {
      if (tally.from_mm >= edges_mm[b] && tally.from_mm < edges_mm[b + 1]) {
        band.Add(tally);
      }
    }
    band.from_mm = edges_mm[b];
    band.to_mm = edges_mm[b + 1];
  }
  return bands;
}

}  // namespace finray

#endif  // FINRAY_TESTS_STUDIES_RAMPS_H_
