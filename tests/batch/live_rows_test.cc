#include "finray/batch/live_rows.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace finray {
namespace {

TEST(LatencyHistogramTest, QuantilesAreThoseOfTheSortedTimes) {
  std::mt19937_64 generator(1);
  std::lognormal_distribution<double> time(std::log(8000), 1.5);
  std::vector<std::uint64_t> times;
  LatencyHistogram histogram;
  for (int i = 0; i < 100000; ++i) {
    times.push_back(static_cast<std::uint64_t>(time(generator)));
    histogram.Add(times.back());
  }
  std::sort(times.begin(), times.end());
  for (const double share : {1e-5, 0.01, 0.5, 0.9, 0.99, 0.999, 0.9999}) {
    const auto exact = static_cast<double>(
        times[static_cast<std::size_t>(std::ceil(share * 1e5 - 1e-6)) - 1]);
    EXPECT_NEAR(histogram.Quantile(share), exact, 0.008 * exact) << share;
  }
  EXPECT_EQ(histogram.max(), times.back());
  EXPECT_EQ(histogram.count(), times.size());
}

TEST(LatencyHistogramTest, SmallTimesAreExactAndLargeOnesHaveAPlace) {
  LatencyHistogram histogram;
  EXPECT_EQ(histogram.Quantile(0.5), 0);
  for (std::uint64_t i = 0; i < 128; ++i) histogram.Add(i);
  for (int i = 1; i <= 128; ++i) {
    EXPECT_EQ(histogram.Quantile(i / 128.0), i - 1);
  }
  const auto largest = std::numeric_limits<std::uint64_t>::max();
  histogram.Add(largest);
  EXPECT_NEAR(histogram.Quantile(1) / std::pow(2.0, 64), 1, 0.008);
  EXPECT_EQ(histogram.max(), largest);
}

}  // namespace
}  // namespace finray
