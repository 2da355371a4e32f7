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

#include <time.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <vector>

#include "finray/estimation/frame_estimator.h"
#include "finray/statics/equilibrium.h"
#include "test_finger.h"

namespace finray {
namespace {

using Contacts = std::vector<PointContact>;

class Lab {
 public:
  explicit Lab(unsigned seed) : random(seed) {}

  // A row with noise and with these errors of the gauges, V.
  Measurements Read(const Contacts& contacts,
                    const std::vector<double>& off_V) {
    Measurements row;
    if (!plant_.Solve(contacts)) std::abort();
    for (std::size_t j = 0; j < finger.gauges.size(); ++j) {
      const Gauge& gauge = finger.gauges[j];
      row.gauges_V.push_back(
          gauge.Volts(plant_.gauge_angle(static_cast<int>(j))) +
          gauge.noise_V * normal(random) + off_V[j]);
    }
    return row;
  }

  const Finger finger = PaperFinger();
  std::mt19937_64 random;
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> share{0, 1};

 private:
  EquilibriumSolver plant_{finger, {Scheme::kTaylor, 48}};
};

double CpuMicroseconds() {
  timespec now;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e6 * static_cast<double>(now.tv_sec) +
         1e-3 * static_cast<double>(now.tv_nsec);
}

void WanderWithErrors(double error_mV, unsigned seed, int frames) {
  Lab lab(seed);
  std::vector<double> off_V;
  for (std::size_t j = 0; j < lab.finger.gauges.size(); ++j) {
    off_V.push_back(std::copysign(1e-3 * error_mV, lab.normal(lab.random)));
  }
  std::vector<Measurements> rows;
  for (int i = 0; i < frames; ++i) {
    rows.push_back(lab.Read(
        {{70 + 40 * std::sin(0.0015 * i), 4 + 3 * std::cos(0.006 * i), 0}},
        off_V));
  }
  Scene one, automatic;
  one.contacts = 1;
  int ok[2] = {}, two = 0;
  std::vector<double> times_us;
  for (const bool is_auto : {false, true}) {
    FrameEstimator estimator(lab.finger, is_auto ? automatic : one);
    estimator.Prepare();
    for (const Measurements& row : rows) {
      const double begin_us = CpuMicroseconds();
      const FrameEstimate& estimate = estimator.Next(row);
      if (is_auto) times_us.push_back(CpuMicroseconds() - begin_us);
      ok[is_auto] += estimate.status == FrameStatus::kOk;
      two += estimate.contacts == 2;
    }
  }
  std::sort(times_us.begin(), times_us.end());
  const auto at = [&](double quantile) {
    return times_us[static_cast<std::size_t>(
        quantile * static_cast<double>(times_us.size() - 1))];
  };
  std::printf("| %g | %u | %.1f | %.1f | %.1f | %.0f | %.0f | %.0f | %.0f |\n",
              error_mV, seed, 100. * ok[0] / frames, 100. * ok[1] / frames,
              100. * two / frames, at(0.5), at(0.99), at(0.999), at(1));
}

void FindPairs(double most_N, int pairs) {
  constexpr double kLeast_N = 0.2, kApart_mm = 8;
  Lab lab(7);
  FrameEstimator estimator(lab.finger, Scene());
  const std::vector<double> no_error(lab.finger.gauges.size(), 0);
  int two = 0, one_ok = 0, one_other = 0, within = 0;
  std::vector<int> iterations;
  for (int i = 0; i < pairs;) {
    const auto place = [&] { return 20 + 100 * lab.share(lab.random); };
    const auto force = [&] {
      return kLeast_N + most_N * lab.share(lab.random);
    };
    Contacts contacts = {{place(), force(), 0}, {place(), force(), 0}};
    if (contacts[0].arc_mm > contacts[1].arc_mm) {
      std::swap(contacts[0], contacts[1]);
    }
    if (contacts[1].arc_mm - contacts[0].arc_mm < kApart_mm) continue;
    ++i;
    const FrameEstimate estimate =
        estimator.Estimate(lab.Read(contacts, no_error));
    if (estimate.contacts == 2) {
      ++two;
      iterations.push_back(estimate.iterations);
      continue;
    }
    const bool is_ok = estimate.status == FrameStatus::kOk;
    ++(is_ok ? one_ok : one_other);
    within += is_ok && estimate.chi2 >= FrameEstimator::kSecondSignificance;
  }
  std::sort(iterations.begin(), iterations.end());
  const auto most =
      static_cast<std::size_t>(0.98 * static_cast<double>(iterations.size()));
  std::printf("| %g | %d | %d | %d | %d | %d |\n", most_N, two, one_ok, within,
              one_other, iterations.empty() ? 0 : iterations[most]);
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
      "\n%d random pairs; of those found, 98 %% within so many iterations:\n\n"
      "| up to, N | two | one, ok | of these chi2 32.2 or more | one, not ok | "
      "iterations |\n|---|---|---|---|---|---|\n",
      pairs);
  for (const double most_N : {3.0, 8.0, 20.0}) finray::FindPairs(most_N, pairs);
}
