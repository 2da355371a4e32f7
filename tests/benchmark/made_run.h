#ifndef FINRAY_TESTS_BENCHMARK_MADE_RUN_H_
#define FINRAY_TESTS_BENCHMARK_MADE_RUN_H_

#include <cmath>
#include <random>
#include <string>

#include "finray/benchmark/benchmark_run.h"

namespace finray {

/// A setting whose rounds took `time_us` on a machine with noise of `noise`,
/// whose clock drifts for solver and yardstick alike.
inline Measurement MadeSetting(const std::string& solver, double time_us,
                               double noise, unsigned seed, int rounds = 25) {
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> normal;
  Measurement m;
  m.name = {"sensing", "one_contact", solver, "alone"};
  m.words = "words, \"quoted\"";
  m.family = "taylor";
  m.errors.contact_mm = 1e-6;
  m.errors.gauges_rad = 1e-9;
  m.solved_percent = 100;
  for (int k = 0; k < rounds; ++k) {
    const double drift = 1 + 0.5 * std::sin(0.3 * k + seed);
    m.time_us.push_back(time_us * drift * std::exp(noise * normal(generator)));
    m.yardstick_us.push_back(100 * drift);
  }
  return m;
}

inline BenchmarkRun MadeRun(double time_us, double noise, unsigned seed) {
  BenchmarkRun run;
  run.rounds = 25;
  run.date = "2020-01-01T00:00:00Z";
  run.machine = {{"cpu", "a CPU"}, {"instruction_set", "AVX2"}};
  run.build = {
      {"version", "0.1.0"}, {"compiler", "GNU 12"}, {"flags", "RELEASE: -O3"}};
  run.settings = {MadeSetting("taylor8x1", time_us, noise, seed)};
  return run;
}

}  // namespace finray

#endif  // FINRAY_TESTS_BENCHMARK_MADE_RUN_H_
