#include "finray/finger/gauge_play.h"

#include <ceres/jet.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace finray {
namespace {

TEST(PlayTest, FollowsAtItsWidth) {
  Play play(1);
  const double signal[] = {0.5, 3, 2.5, 1.2, 0.5, -4, -4.5, -3.9, -2};
  const double expected[] = {0, 2, 2, 2, 1.5, -3, -3.5, -3.5, -3};
  for (int i = 0; i < 9; ++i)
    EXPECT_DOUBLE_EQ(play.Next(signal[i]), expected[i]);
}

struct Shares {
  int within_68 = 0, within_95 = 0, count = 0;
};

// How often s lies within the intervals about the reading and the mean of d.
// The other gauges of the finger scatter by `others`.
Shares Covered(const std::vector<double>& signal, double width, double others) {
  std::mt19937_64 generator(7);
  std::normal_distribution<double> normal;
  Play play(width);
  PlayBelief<double> belief(width);
  Shares shares;
  double last = 0;
  for (std::size_t i = 0; i < signal.size(); ++i) {
    const double p = play.Next(signal[i]), u = p + normal(generator);
    double moved2 = std::pow(u - last, 2);
    for (int k = 0; k < 3; ++k) {
      moved2 += std::pow((others + M_SQRT2) * normal(generator), 2);
    }
    belief.Next(u, moved2 / 4);
    last = u;
    if (i == 0) continue;
    const double off = std::abs(signal[i] - u - belief.mean()) /
                       std::sqrt(1 + belief.variance());
    shares.within_68 += off < 1;
    shares.within_95 += off < 1.96;
    ++shares.count;
  }
  return shares;
}

TEST(PlayBeliefTest, TouchesInAnyOrderAreCovered) {
  std::mt19937_64 generator(3);
  std::vector<double> signal(5000);
  std::uniform_real_distribution<double> place(-100, 100);
  for (double& s : signal) s = place(generator);
  const Shares shares = Covered(signal, 7, 100);
  EXPECT_NEAR(shares.within_68 / double(shares.count), 0.683, 0.02);
  EXPECT_NEAR(shares.within_95 / double(shares.count), 0.95, 0.01);
}

TEST(PlayBeliefTest, AGaugeThatHasNotMovedIsAnywhereInTheBand) {
  PlayBelief<double> belief(7);
  belief.Next(0, 1e4);
  belief.Next(100, 1e4);
  EXPECT_NEAR(belief.mean(), 7, 1e-6);
  EXPECT_NEAR(belief.variance(), 0, 1e-6);
  belief.Next(-50, 1e4);
  EXPECT_NEAR(belief.mean(), -7, 1e-6);
  // Still against moved is as 2 w phi(0; 2) against 1, and moved is up or down.
  belief.Next(-50, 1e4);
  const double still = 2 * 7 / std::sqrt(4 * M_PI);
  EXPECT_NEAR(belief.mean(), 0, 0.1);
  EXPECT_NEAR(belief.variance(), 7 * 7 * (still / 3 + 1) / (still + 1), 0.5);
}

TEST(PlayBeliefTest, AHeldFingerKeepsWhatIsKnown) {
  PlayBelief<double> belief(7);
  belief.Next(0, 2);
  belief.Next(100, 1e4);
  for (int i = 0; i < 50; ++i) belief.Next(100 + (i % 2 ? 0.7 : -0.7), 2);
  EXPECT_GT(belief.mean(), 6);
  for (int i = 0; i < 100000; ++i) belief.Next(100 + (i % 2 ? 0.7 : -0.7), 2);
  EXPECT_GT(std::sqrt(belief.variance()), 2);
}

TEST(PlayBeliefTest, DerivativesAgreeWithCentralDifferences) {
  using Jet = ceres::Jet<double, 1>;
  const double signal[] = {0, 40, 40.5, 39, 10, 11.5, 90, 88, 87.5, -3};
  for (const double width : {7.0, 1.5, 1e-9, -2.0}) {
    const double step = 1e-6;
    PlayBelief<Jet> belief(Jet(width, 0));
    PlayBelief<double> less(width - step), more(width + step);
    for (const double u : signal) {
      belief.Next(Jet(u), 900);
      less.Next(u, 900);
      more.Next(u, 900);
      EXPECT_NEAR(belief.mean().v[0], (more.mean() - less.mean()) / (2 * step),
                  1e-5)
          << width << " at " << u;
    }
  }
}

}  // namespace
}  // namespace finray
