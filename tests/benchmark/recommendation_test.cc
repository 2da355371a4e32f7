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
  m.slow_frame_us = slow_us;
  m.solved_percent = 100;
  return m;
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
  const std::vector<Recommendation> found = Recommend(all);
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
  EXPECT_EQ(Recommend(all)[1].id, "estimation/one_contact/default/live");
  all[2].time_us.assign(9, 35);
  EXPECT_EQ(Recommend(all)[1].id, "estimation/one_contact/as_good/live");
}

TEST(RecommendationTest, NothingServes) {
  const std::vector<Recommendation> found =
      Recommend({Made("estimation", "slow", "live", 5e3, 1e-6, 9e3)});
  EXPECT_EQ(found[0].id, "");
  EXPECT_EQ(found[1].id, "");
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

}  // namespace
}  // namespace finray
