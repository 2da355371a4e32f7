#include "finray/benchmark/run_comparison.h"

#include <gmock/gmock.h>

#include "benchmark/made_run.h"

namespace finray {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

SpeedVerdict VerdictOf(double factor, double noise, unsigned seed) {
  const BenchmarkComparison found = CompareRuns(
      MadeRun(10, noise, seed), MadeRun(10 * factor, noise, seed + 1), 0.15);
  return found.settings.at(0).speed;
}

TEST(ComparisonTest, NoiseWithoutAChangeIsTheSame) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    EXPECT_EQ(VerdictOf(1, 0.05, 10 * seed), SpeedVerdict::kSame) << seed;
  }
}

TEST(ComparisonTest, LongerAndShorterTimesAreSeen) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    EXPECT_EQ(VerdictOf(1.3, 0.05, 10 * seed), SpeedVerdict::kSlower) << seed;
    EXPECT_EQ(VerdictOf(0.7, 0.05, 10 * seed), SpeedVerdict::kFaster) << seed;
  }
}

TEST(ComparisonTest, WhatNoiseHidesIsUndecided) {
  int decided = 0;
  for (unsigned seed = 0; seed < 20; ++seed) {
    const SpeedVerdict verdict = VerdictOf(1.15, 0.3, 10 * seed);
    EXPECT_NE(verdict, SpeedVerdict::kFaster);
    decided += verdict != SpeedVerdict::kUndecided;
  }
  EXPECT_LE(decided, 2);
}

TEST(ComparisonTest, VerdictsOfIntervals) {
  EXPECT_EQ(JudgeSpeed({1.16, 1.4}, 0.15), SpeedVerdict::kSlower);
  EXPECT_EQ(JudgeSpeed({1.14, 1.4}, 0.15), SpeedVerdict::kUndecided);
  EXPECT_EQ(JudgeSpeed({0.9, 1.1}, 0.15), SpeedVerdict::kSame);
  EXPECT_EQ(JudgeSpeed({0.6, 0.86}, 0.15), SpeedVerdict::kFaster);
  EXPECT_EQ(JudgeSpeed({0.6, 0.88}, 0.15), SpeedVerdict::kUndecided);
  const double nan = std::nan("");
  EXPECT_EQ(JudgeSpeed({nan, nan}, 0.15), SpeedVerdict::kUndecided);
}

TEST(ComparisonTest, TwoRoundsDecideNothing) {
  BenchmarkRun a = MadeRun(10, 0.01, 1), b = MadeRun(20, 0.01, 2);
  a.settings[0].time_us.resize(2);
  a.settings[0].yardstick_us.resize(2);
  EXPECT_EQ(CompareRuns(a, b, 0.15).settings[0].speed,
            SpeedVerdict::kUndecided);
}

TEST(ComparisonTest, PeersAreLeftOut) {
  BenchmarkRun a = MadeRun(10, 0.01, 1), b = MadeRun(10, 0.01, 2);
  a.settings.push_back(MadeSetting("scipy40", 1e6, 0.01, 3, 1));
  a.settings.back().name.how = "peer";
  b.settings.push_back(a.settings.back());
  b.settings.back().time_us[0] *= 3;
  const BenchmarkComparison found = CompareRuns(a, b, 0.15);
  EXPECT_EQ(found.settings.size(), 1u);
  EXPECT_TRUE(found.passes());
}

TEST(ComparisonTest, LessAccurateFailsTheGate) {
  const BenchmarkRun a = MadeRun(10, 0.01, 1);
  BenchmarkRun b = MadeRun(5, 0.01, 2);
  EXPECT_TRUE(CompareRuns(a, b, 0.15).passes());
  b.settings[0].errors.contact_mm = 2e-6;
  const BenchmarkComparison found = CompareRuns(a, b, 0.15);
  EXPECT_FALSE(found.passes());
  EXPECT_EQ(found.settings[0].worse, "contact_mm 1e-06 -> 2e-06");
  // 1e-9 to 2e-9 rad is rounding.
  b = MadeRun(5, 0.01, 2);
  b.settings[0].errors.gauges_rad = 2e-9;
  EXPECT_TRUE(CompareRuns(a, b, 0.15).passes());
  b.settings[0].solved_percent = 99;
  EXPECT_THAT(CompareRuns(a, b, 0.15).settings[0].worse,
              HasSubstr("solved 100 % -> 99 %"));
}

TEST(ComparisonTest, OtherMachinesAndSettingsAreNamed) {
  const BenchmarkRun a = MadeRun(10, 0.01, 1);
  BenchmarkRun b = MadeRun(10, 0.01, 2);
  EXPECT_THAT(CompareRuns(a, b, 0.15).differences, IsEmpty());
  b.machine["cpu"] = "another";
  b.settings.push_back(MadeSetting("taylor12x1", 10, 0.01, 3));
  const BenchmarkComparison found = CompareRuns(a, b, 0.15);
  EXPECT_THAT(found.differences, ElementsAre("machine: a CPU against another"));
  EXPECT_THAT(found.only_b,
              ElementsAre("sensing/one_contact/taylor12x1/alone"));
  EXPECT_THAT(found.only_a, IsEmpty());
}

}  // namespace
}  // namespace finray
