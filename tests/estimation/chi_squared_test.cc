#include "finray/estimation/chi_squared.h"

#include <gtest/gtest.h>

#include <cmath>

namespace finray {
namespace {

TEST(ChiSquaredTest, AgreesWithTables) {
  // scipy.stats.chi2.sf(chi2, dof)
  EXPECT_NEAR(ChiSquaredTail(3.841458820694124, 1), 0.05, 1e-12);
  EXPECT_NEAR(ChiSquaredTail(5.991464547107979, 2), 0.05, 1e-12);
  EXPECT_NEAR(ChiSquaredTail(7.814727903251179, 3), 0.05, 1e-12);
  EXPECT_NEAR(ChiSquaredTail(9.487729036781154, 4), 0.05, 1e-12);
  EXPECT_NEAR(ChiSquaredTail(18.307038053275146, 10), 0.05, 1e-12);
  EXPECT_NEAR(ChiSquaredTail(13.815510557964274, 2), 1e-3, 1e-14);
  EXPECT_EQ(ChiSquaredTail(0, 4), 1);
  EXPECT_LT(ChiSquaredTail(1e4, 3), 1e-300);
  EXPECT_TRUE(std::isnan(ChiSquaredTail(1, 0)));
}

}  // namespace
}  // namespace finray
