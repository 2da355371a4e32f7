#include "finray/scene/measured_force.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "finray/scene/measurements.h"

namespace finray {
namespace {

TEST(MeasuredForceTest, TwoAxesCountBeforeOne) {
  Measurements row;
  EXPECT_FALSE(row.Force().IsMeasured());
  EXPECT_TRUE(std::isnan(row.Force().magnitude_N));
  row.force_N = -0.01;  // noise about zero
  EXPECT_EQ(row.Force().axes, 1);
  EXPECT_EQ(row.Force().magnitude_N, -0.01);
  row.force_xy_N.x() = 3;  // the other axis is missing
  EXPECT_EQ(row.Force().axes, 1);
  row.force_xy_N.y() = -4;
  EXPECT_EQ(row.Force().axes, 2);
  EXPECT_EQ(row.Force().magnitude_N, 5);
}

// Noise passes for a force as rarely with two axes as with one: 0.27 %. The
// magnitude of two axes is above 3 std in 1.1 %.
TEST(MeasuredForceTest, NoisePassesAsRarelyWithTwoAxes) {
  constexpr int kDraws = 200000;
  constexpr double kStd_N = 0.03;
  std::mt19937_64 random(1);
  std::normal_distribution<double> noise(0, kStd_N);
  const double nan = Measurements::kNotMeasured;
  int one = 0, two = 0;
  for (int i = 0; i < kDraws; ++i) {
    const Eigen::Vector2d xy(noise(random), noise(random));
    one += !MeasuredForce::Of(xy.x(), {nan, nan}).IsWithinNoise(kStd_N);
    two += !MeasuredForce::Of(nan, xy).IsWithinNoise(kStd_N);
  }
  const double expected = 0.0027 * kDraws, tolerance = 4 * std::sqrt(expected);
  EXPECT_NEAR(one, expected, tolerance);
  EXPECT_NEAR(two, expected, tolerance);
  EXPECT_FALSE(MeasuredForce().IsWithinNoise(1));
}

}  // namespace
}  // namespace finray
