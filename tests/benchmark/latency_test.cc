#include "finray/benchmark/latency.h"

#include <gtest/gtest.h>

#include "finray/statics/equilibrium.h"
#include "test_finger.h"

namespace finray {
namespace {

TEST(LatencyTest, TheWrongFingerIsSlightlyWrong) {
  const Finger right = PaperFinger(), wrong = SlightlyWrong(right);
  EXPECT_NEAR(wrong.front_stiffness_N_mm2 / right.front_stiffness_N_mm2, 1.01,
              1e-12);
  for (std::size_t i = 0; i < right.ribs.size(); ++i) {
    EXPECT_NEAR(std::abs(wrong.ribs[i].length_mm - right.ribs[i].length_mm),
                0.03, 1e-12);
  }
  const std::vector<Measurements> a = LatencyReadings(right, 1),
                                  b = LatencyReadings(wrong, 1);
  double largest = 0;
  for (std::size_t j = 0; j < right.gauges.size(); ++j) {
    largest = std::max(largest, std::abs(a[0].gauges_V[j] - b[0].gauges_V[j]) /
                                    right.gauges[j].noise_V);
  }
  // Readings differ by some std, by far more than between discretizations.
  EXPECT_GT(largest, 1);
  EXPECT_LT(largest, 50);
}

TEST(LatencyTest, ALimitBoundsTheIterations) {
  const std::vector<Latency> all = MeasureLatencies(PaperFinger(), 400, 1);
  ASSERT_EQ(all.size(), 8u);
  for (const Latency& one : all) {
    SCOPED_TRACE(one.finger + ", contacts: " + one.contacts);
    EXPECT_EQ(one.frames, 400);
    EXPECT_GT(one.ok, 100);
    EXPECT_LE(one.p50_us, one.p99_us);
    EXPECT_LE(one.p999_us, one.max_us);
    if (one.iteration_limit) {
      EXPECT_LE(one.most_iterations, *one.iteration_limit);
    } else {
      EXPECT_EQ(one.ended, 0);
      // One contact, and what is left to a pair that explains anything.
      EXPECT_LT(one.most_iterations, 200);
    }
  }
}

}  // namespace
}  // namespace finray
