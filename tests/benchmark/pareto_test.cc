#include "finray/benchmark/pareto.h"

#include <gmock/gmock.h>

namespace finray {
namespace {

using testing::ElementsAre;

Measurement Made(const char* scene, const char* solver, double time_us,
                 double contact_mm, double solved_percent = 100) {
  Measurement m;
  m.name = {"sensing", scene, solver, "alone"};
  m.time_us = {time_us, time_us, time_us};
  m.yardstick_us = {100, 100, 100};
  m.errors.contact_mm = contact_mm;
  m.solved_percent = solved_percent;
  return m;
}

TEST(ParetoTest, TheFrontOfHandMadePoints) {
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
    all.push_back(Made("one_contact", "a", time_us, contact_mm));
  }
  EXPECT_THAT(ParetoFronts(all).at(0).front, ElementsAre(5, 0, 1, 4));
}

bool Beats(double time_a, double error_a, double time_b, double error_b) {
  return Dominates(Made("one_contact", "a", time_a, error_a),
                   Made("one_contact", "b", time_b, error_b), time_a / time_b);
}

TEST(ParetoTest, NoiseMakesNoDominance) {
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

TEST(ParetoTest, ACoarserTipIsNoDominance) {
  Measurement a = Made("one_contact", "a", 1, 1e-6);
  Measurement b = Made("one_contact", "b", 10, 1e-6);
  a.errors.tip_mm = 2.1e-8;
  b.errors.tip_mm = 1e-8;
  EXPECT_FALSE(Dominates(a, b, 0.1));
  a.errors.tip_mm = 1.9e-8;
  EXPECT_TRUE(Dominates(a, b, 0.1));
}

TEST(ParetoTest, FrontsAreBySceneAndOfSolversThatSolveAll) {
  const std::vector<Measurement> all = {
      Made("one_contact", "slow", 100, 1e-3), Made("friction", "only", 1e3, 1),
      Made("one_contact", "fast", 10, 1e-3),
      Made("one_contact", "loses_frames", 1, 1e-9, 90)};
  const std::vector<SceneFront> fronts = ParetoFronts(all);
  ASSERT_EQ(fronts.size(), 2u);
  EXPECT_EQ(fronts[0].scene, "one_contact");
  EXPECT_THAT(fronts[0].front, ElementsAre(2));
  EXPECT_THAT(fronts[1].front, ElementsAre(1));
}

}  // namespace
}  // namespace finray
