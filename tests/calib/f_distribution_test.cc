#include "finray/calib/analysis/f_distribution.h"

#include <gtest/gtest.h>

#include <cmath>

namespace finray {
namespace {

// Closed forms: d1 = 2, and Student's t of one and two degrees.
TEST(FDistributionTest, ClosedForms) {
  for (const double f : {0.01, 0.5, 1.0, 4.0, 30.0, 900.0}) {
    for (const int d2 : {1, 2, 7, 60}) {
      const double expected = std::pow(1 + 2 * f / d2, -0.5 * d2);
      EXPECT_NEAR(FTail(f, 2, d2) / expected, 1, 1e-12);
    }
    const double t = std::sqrt(f);
    EXPECT_NEAR(FTail(f, 1, 1), 1 - 2 / M_PI * std::atan(t), 1e-13);
    EXPECT_NEAR(FTail(f, 1, 2), 1 - t / std::sqrt(2 + f), 1e-13);
    // X and 1 / X.
    EXPECT_NEAR(FTail(f, 5, 8), 1 - FTail(1 / f, 8, 5), 1e-13);
  }
}

TEST(FDistributionTest, Edges) {
  EXPECT_EQ(FTail(0, 3, 4), 1);
  EXPECT_EQ(FTail(INFINITY, 3, 4), 0);
  EXPECT_TRUE(std::isnan(FTail(1, 0, 4)));
  EXPECT_TRUE(std::isnan(FTail(NAN, 1, 4)));
}

}  // namespace
}  // namespace finray
