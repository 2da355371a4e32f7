#include "finray/benchmark/recommendation.h"

#include <gmock/gmock.h>

namespace finray {
namespace {

using testing::ElementsAre;

Measurement Made(const char* task, const char* solver, const char* how,
                 double time_us, double contact_mm,
                 double slow_us = std::nan("")) {
  Measurement m;
  m.name = {task, "one_contact", solver, how};
  m.time_us.assign(9, time_us);
  m.yardstick_us.assign(9, 100);
  m.errors.contact_mm = contact_mm;
  m.errors.contacts = 1;
  m.errors.contact_squares_mm2 = contact_mm * contact_mm;
  m.errors.normal_squares_N2 = 0.01 * contact_mm * contact_mm;
  m.slow_frame_us = slow_us;
  m.solved_percent = 100;
  return m;
}

NoiseFloor Floor(double contact_mm, double normal_N) {
  return {"one_contact", 3e-4, contact_mm, normal_N};
}

TEST(RecommendationTest, EachUseGetsItsOwn) {
  const std::vector<Measurement> all = {
      Made("estimation", "coarse", "live", 5, 1e-2, 10),
      Made("estimation", "exact", "live", 50, 1e-6, 90),
      // In a tenth of 33 ms but not of 1 ms.
      Made("estimation", "slow_and_exact", "live", 200, 1e-7, 500),
      Made("estimation", "too_coarse", "block", 1, 1e-2),
      Made("estimation", "good", "block", 2, 1e-4),
      Made("estimation", "better", "block", 3, 1e-6),
      Made("sensing", "rough", "to_rounding", 10, 1e-3),
      Made("sensing", "finest", "to_rounding", 1000, 1e-12),
      Made("sensing", "as_fine", "to_rounding", 900, 5e-10)};
  const std::vector<Recommendation> found = Recommend(all, Floor(0.02, 0.01));
  ASSERT_EQ(found.size(), 4u);
  EXPECT_EQ(found[0].id, "estimation/one_contact/slow_and_exact/live");
  EXPECT_NEAR(found[0].margin(), 1e6 / 30 / 500, 1e-9);
  EXPECT_EQ(found[1].id, "estimation/one_contact/exact/live");
  EXPECT_NEAR(found[1].margin(), 1000. / 90, 1e-9);
  EXPECT_EQ(found[2].id, "estimation/one_contact/good/block");
  EXPECT_EQ(found[3].id, "sensing/one_contact/as_fine/to_rounding");
}

// A scheme that is as good in l_c alone, and one that is as good in all.
TEST(RecommendationTest, AccuracyIsThatOfAllErrors) {
  std::vector<Measurement> all = {
      Made("estimation", "default", "live", 50, 1e-6, 90),
      Made("estimation", "coarse_tip", "live", 30, 1e-6, 50),
      Made("estimation", "as_good", "live", 45, 1e-6, 80)};
  for (Measurement& m : all) m.errors.tip_mm = 1e-8;
  all[1].errors.tip_mm = 1e-7;
  EXPECT_EQ(Recommend(all, Floor(0.02, 0.01))[1].id,
            "estimation/one_contact/default/live");
  all[2].time_us.assign(9, 35);
  EXPECT_EQ(Recommend(all, Floor(0.02, 0.01))[1].id,
            "estimation/one_contact/as_good/live");
}

TEST(RecommendationTest, NothingServes) {
  const std::vector<Recommendation> found = Recommend(
      {Made("estimation", "slow", "live", 5e3, 1e-6, 9e3)}, Floor(0.02, 0.01));
  EXPECT_EQ(found[0].id, "");
  EXPECT_EQ(found[1].id, "");
}

// Noise decides how coarse a solver may be. Coarse gauges allow more of them.
TEST(RecommendationTest, EnoughAgainstTheNoise) {
  const std::vector<Measurement> all = {
      Made("estimation", "default", "block", 10, 1e-6),
      Made("estimation", "taylor8x1", "block", 8, 1e-4),
      Made("estimation", "taylor4x2", "block", 5, 4e-2),
      Made("estimation", "taylor4x1", "block", 4, 0.2)};
  const auto id = [&](const NoiseFloor& floor) {
    return EnoughAgainstNoise(all, floor).at(0).id;
  };
  EXPECT_EQ(id(Floor(0.81, 1)), "estimation/one_contact/taylor4x1/block");
  EXPECT_EQ(id(Floor(0.5, 1)), "estimation/one_contact/taylor4x2/block");
  EXPECT_EQ(id(Floor(0.15, 1)), "estimation/one_contact/taylor8x1/block");
  // The force has a noise of its own.
  EXPECT_EQ(id(Floor(0.5, 0.015)), "estimation/one_contact/taylor8x1/block");
  EXPECT_EQ(id(Floor(1e-4, 1)), "estimation/one_contact/default/block");
  const EnoughSetting found = EnoughAgainstNoise(all, Floor(0.5, 1)).at(0);
  EXPECT_EQ(found.default_id, "estimation/one_contact/default/block");
  EXPECT_NEAR(found.times_faster, 2, 1e-12);
  EXPECT_NEAR(found.interval.low, 2, 1e-12);
  EXPECT_NEAR(found.contact_rms_mm, 4e-2, 1e-12);
  // A coarser one that is hardly faster is not worth it.
  std::vector<Measurement> close = all;
  close[1].time_us.assign(9, 5.1);
  EXPECT_EQ(EnoughAgainstNoise(close, Floor(0.5, 1)).at(0).id,
            "estimation/one_contact/taylor8x1/block");
  // Without a floor nothing is known.
  EXPECT_TRUE(EnoughAgainstNoise(all, {}).empty());
  EXPECT_TRUE(EnoughAgainstNoise(all, Floor(1e-7, 1)).empty());
}

TEST(RecommendationTest, TheDefaultIsChecked) {
  std::vector<Measurement> all = {
      Made("sensing", "default", "alone", 10, 1e-6),
      Made("sensing", "taylor12x1", "alone", 9, 1.5e-6),
      Made("sensing", "coarse", "alone", 1, 1e-2)};
  std::vector<DefaultCheck> checks = CheckDefaults(all);
  ASSERT_EQ(checks.size(), 1u);
  EXPECT_TRUE(checks[0].holds());
  EXPECT_EQ(checks[0].rival, "sensing/one_contact/taylor12x1/alone");
  EXPECT_NEAR(checks[0].rival_time, 0.9, 1e-12);
  all.push_back(Made("sensing", "new", "alone", 7, 0.5e-6));
  checks = CheckDefaults(all);
  EXPECT_FALSE(checks[0].holds());
  EXPECT_THAT(checks[0].better, ElementsAre("sensing/one_contact/new/alone"));
  EXPECT_THAT(checks[0].dominated_by,
              ElementsAre("sensing/one_contact/new/alone"));
}

Measurement OnAxes(const char* scene, const char* solver, double time_us,
                   double contact_mm, double solved_percent = 100) {
  Measurement m;
  m.name = {"sensing", scene, solver, "alone"};
  m.time_us = {time_us, time_us, time_us};
  m.yardstick_us = {100, 100, 100};
  m.errors.contact_mm = contact_mm;
  m.solved_percent = solved_percent;
  return m;
}

TEST(RecommendationTest, TheFrontOfHandMadePoints) {
  const std::pair<double, double> points[] = {
      {10, 1e-3},   // 0: on the front
      {20, 1e-6},   // 1: on the front
      {20, 1e-4},   // 2: as fast as 1 and coarser
      {15, 2e-3},   // 3: slower and coarser than 0
      {100, 1e-9},  // 4: the most accurate
      {5, 1},       // 5: the fastest
  };
  std::vector<Measurement> all;
  for (const auto& [time_us, contact_mm] : points) {
    all.push_back(OnAxes("one_contact", "a", time_us, contact_mm));
  }
  EXPECT_THAT(ParetoFronts(all).at(0).front, ElementsAre(5, 0, 1, 4));
}

bool Beats(double time_a, double error_a, double time_b, double error_b) {
  return Dominates(OnAxes("one_contact", "a", time_a, error_a),
                   OnAxes("one_contact", "b", time_b, error_b),
                   time_a / time_b);
}

TEST(RecommendationTest, NoiseMakesNoDominance) {
  // 10 % faster at an equal error: two runs may differ by that.
  EXPECT_FALSE(Beats(9, 1e-6, 10, 1e-6));
  EXPECT_TRUE(Beats(8, 1e-6, 10, 1e-6));
  // As fast to 3 %, clearly more accurate.
  EXPECT_TRUE(Beats(10.3, 1e-7, 10, 1e-6));
  EXPECT_FALSE(Beats(10.3, 0.8e-6, 10, 1e-6));
  // Much faster but coarser.
  EXPECT_FALSE(Beats(1, 1.1e-6, 10, 1e-6));
  EXPECT_FALSE(Beats(10, 1e-6, 10, 1e-6));
}

TEST(RecommendationTest, ACoarserTipIsNoDominance) {
  Measurement a = OnAxes("one_contact", "a", 1, 1e-6);
  Measurement b = OnAxes("one_contact", "b", 10, 1e-6);
  a.errors.tip_mm = 2.1e-8;
  b.errors.tip_mm = 1e-8;
  EXPECT_FALSE(Dominates(a, b, 0.1));
  a.errors.tip_mm = 1.9e-8;
  EXPECT_TRUE(Dominates(a, b, 0.1));
}

TEST(RecommendationTest, FrontsAreBySceneAndOfSolversThatSolveAll) {
  const std::vector<Measurement> all = {
      OnAxes("one_contact", "slow", 100, 1e-3),
      OnAxes("friction", "only", 1e3, 1),
      OnAxes("one_contact", "fast", 10, 1e-3),
      OnAxes("one_contact", "loses_frames", 1, 1e-9, 90)};
  const std::vector<SceneFront> fronts = ParetoFronts(all);
  ASSERT_EQ(fronts.size(), 2u);
  EXPECT_EQ(fronts[0].scene, "one_contact");
  EXPECT_THAT(fronts[0].front, ElementsAre(2));
  EXPECT_THAT(fronts[1].front, ElementsAre(1));
}

}  // namespace
}  // namespace finray
