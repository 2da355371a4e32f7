#include <gtest/gtest.h>

#include <cmath>

#include "finray/control/controller.h"

namespace finray {
namespace {

TEST(TrajectoryTest, HarmonicAndTriangular) {
  const Trajectory harmonic = Trajectory::Wave(4, 2, 3);
  EXPECT_DOUBLE_EQ(harmonic.At(0.75), 6);
  EXPECT_NEAR(harmonic.At(0.25), 5, 1e-12);
  const Trajectory triangular = Trajectory::Wave(4, 2, 4, true);
  EXPECT_NEAR(triangular.At(0.25), 4.5, 1e-12);
  EXPECT_NEAR(triangular.At(1.5), 5, 1e-12);
  EXPECT_NEAR(triangular.At(3), 2, 1e-12);
  EXPECT_DOUBLE_EQ(triangular.Middle(), 4);
}

TEST(TrajectoryTest, StepsJumpAtTheirTime) {
  const Trajectory steps{{4, 6, 10}, 1};
  EXPECT_DOUBLE_EQ(steps.At(-1), 4);
  EXPECT_DOUBLE_EQ(steps.At(0.999), 4);
  // 30 periods of 1 / 30 s are a second, apart from rounding.
  double second = 0;
  for (int i = 0; i < 30; ++i) second += 1.0 / 30;
  EXPECT_DOUBLE_EQ(steps.At(second), 6);
  EXPECT_DOUBLE_EQ(steps.At(99), 10);
  EXPECT_DOUBLE_EQ(steps.Middle(), 7);
  EXPECT_TRUE(std::isinf(steps.SinceStep(0.5)));
  EXPECT_NEAR(steps.SinceStep(2.25), 0.25, 1e-12);
}

TEST(TrajectoryTest, RampsLeadFromLevelToLevel) {
  const Trajectory steps{{4, 6}, 1, 0.5};
  EXPECT_DOUBLE_EQ(steps.At(1), 4);
  EXPECT_DOUBLE_EQ(steps.At(1.25), 5);
  EXPECT_DOUBLE_EQ(steps.At(1.5), 6);
}

}  // namespace
}  // namespace finray
