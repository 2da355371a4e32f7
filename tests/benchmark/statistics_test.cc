#include "finray/benchmark/statistics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace finray {
namespace {

TEST(StatisticsTest, QuantilesAreLinearBetweenValues) {
  const std::vector<double> values = {4, 1, 3, 2};
  EXPECT_DOUBLE_EQ(Median(values), 2.5);
  EXPECT_DOUBLE_EQ(Quantile(values, 0), 1);
  EXPECT_DOUBLE_EQ(Quantile(values, 1), 4);
  EXPECT_DOUBLE_EQ(Quantile(values, 0.25), 1.75);
  EXPECT_TRUE(std::isnan(Median({})));
}

// The interval of a ratio of quantiles holds the truth about as often as it
// says.
TEST(StatisticsTest, BootstrapCoversTheRatio) {
  std::mt19937_64 generator(3);
  std::normal_distribution<double> noise(0, 0.1);
  int covered = 0;
  const int runs = 100;
  for (int run = 0; run < runs; ++run) {
    std::vector<double> a(25), b(25);
    for (double& value : a) value = std::exp(noise(generator));
    for (double& value : b) value = 1.3 * std::exp(noise(generator));
    const Interval interval = RatioOfQuantiles(a, b, 0.25, 0.9);
    EXPECT_LT(interval.low, interval.high);
    covered += interval.low <= 1.3 && 1.3 <= interval.high;
  }
  EXPECT_GE(covered, 75);
  EXPECT_LE(covered, 99);
}

}  // namespace
}  // namespace finray
