// `contacts: auto` on the four gauges of the paper's finger, where two contacts
// explain nearly any reading:
//
// - one contact that wanders over the finger, with an error of every gauge that
//   does not change (its sign by lot): shares of frames that are ok, with
//   `contacts: 1` and with auto, of frames with two contacts, and the time that
//   a live frame takes;
// - two contacts at random places with random forces: the contacts found.
//
// The plant has other elements than the estimate, but the same physics.
//
//   build/test/tests/doubted_pairs_study [FRAMES [PAIRS]]    3000, 1000

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <vector>

#include "finray/benchmark/latency.h"
#include "finray/benchmark/statistics.h"
#include "finray/estimation/frame_estimator.h"
#include "studies/pair_log.h"
#include "test_finger.h"

namespace finray {
namespace {

void WanderWithErrors(double error_mV, unsigned seed, int frames) {
  const Finger finger = PaperFinger();
  std::vector<Measurements> rows = LatencyReadings(finger, frames);
  std::mt19937_64 generator(seed);
  std::bernoulli_distribution positive;
  for (std::size_t j = 0; j < finger.gauges.size(); ++j) {
    const double off_V = (positive(generator) ? 1e-3 : -1e-3) * error_mV;
    for (Measurements& row : rows) row.gauges_V[j] += off_V;
  }
  Scene one, automatic;
  one.contacts = 1;
  int ok[2] = {}, two = 0;
  std::vector<double> times_us;
  for (const bool is_auto : {false, true}) {
    FrameEstimator estimator(finger, is_auto ? automatic : one);
    estimator.Prepare();
    for (const Measurements& row : rows) {
      const double begin_s = ThreadSeconds();
      const FrameEstimate& estimate = estimator.Next(row);
      if (is_auto) times_us.push_back(1e6 * (ThreadSeconds() - begin_s));
      ok[is_auto] += estimate.status == FrameStatus::kOk;
      two += estimate.contacts == 2;
    }
  }
  std::printf("| %g | %u | %.1f | %.1f | %.1f | %.0f | %.0f | %.0f | %.0f |\n",
              error_mV, seed, 100. * ok[0] / frames, 100. * ok[1] / frames,
              100. * two / frames, Quantile(times_us, 0.5),
              Quantile(times_us, 0.99), Quantile(times_us, 0.999),
              Quantile(times_us, 1));
}

void FindPairs(double most_N, int pairs) {
  const Finger finger = PaperFinger();
  std::mt19937_64 generator(7);
  std::uniform_real_distribution<double> place(20, 120), force(0.2, most_N);
  const PairLog log = SimulatePairs(finger, pairs, [&](int) {
    constexpr double kApart_mm = 8;
    for (;;) {
      PairOfContacts pair = {{place(generator), force(generator), 0},
                             {place(generator), force(generator), 0}};
      if (pair[0].arc_mm > pair[1].arc_mm) std::swap(pair[0], pair[1]);
      if (pair[1].arc_mm - pair[0].arc_mm > kApart_mm) return pair;
    }
  });
  FrameEstimator estimator(finger, Scene());
  int one_ok = 0, may_be_two = 0, one_other = 0;
  std::vector<double> iterations;  // of frames with two
  for (const Measurements& row : log.rows) {
    const FrameEstimate estimate = estimator.Estimate(row);
    const bool is_ok = estimate.status == FrameStatus::kOk;
    if (estimate.contacts == 2) {
      iterations.push_back(estimate.iterations);
    } else {
      ++(is_ok ? one_ok : one_other);
      may_be_two += is_ok && estimate.may_be_two;
    }
  }
  std::printf("| %g | %zu | %d | %d | %d | %.0f |\n", most_N, iterations.size(),
              one_ok, may_be_two, one_other, Quantile(iterations, 0.9));
}

}  // namespace
}  // namespace finray

int main(int argc, char** argv) {
  const int frames = argc > 1 ? std::atoi(argv[1]) : 3000;
  const int pairs = argc > 2 ? std::atoi(argv[2]) : 1000;
  std::printf(
      "One contact, every gauge off by an error that does not change; live, "
      "%d frames, us of CPU:\n\n"
      "| error, mV | seed | ok, `contacts: 1`, %% | ok, auto, %% | two "
      "contacts, %% | p50 | p99 | p99.9 | largest |\n"
      "|---|---|---|---|---|---|---|---|---|\n",
      frames);
  for (const double error_mV : {0.0, 1.0, 2.0, 3.0, 5.0}) {
    for (const unsigned seed : {1u, 2u, 3u}) {
      finray::WanderWithErrors(error_mV, seed, frames);
    }
  }
  std::printf(
      "\n%d random pairs; of those found, 90 %% within so many iterations:\n\n"
      "| up to, N | two | one, ok | of these chi2 32.2 or more | one, not ok | "
      "iterations |\n|---|---|---|---|---|---|\n",
      pairs);
  for (const double most_N : {3.0, 8.0, 20.0}) finray::FindPairs(most_N, pairs);
}
