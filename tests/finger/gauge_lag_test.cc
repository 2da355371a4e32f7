#include "finray/finger/gauge_lag.h"

#include <ceres/jet.h>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace finray {
namespace {

const std::vector<double> kTimes = {0, 1, 1.5, 1.501, 30, 31, 200};
const std::vector<double> kSignal = {0.3, 0.5, 0.5, 0.9, -0.2, 0.1, 0.4};

double LastLag(double share, double time_constant_s) {
  GaugeLag<double> lag(share, time_constant_s);
  double z = 0;
  for (std::size_t i = 0; i < kTimes.size(); ++i) {
    z = lag.Next(kTimes[i], kSignal[i]);
  }
  return z;
}

// tau dz/dt = u - (1 + c) z, in many small explicit steps.
TEST(GaugeLagTest, AgreesWithSmallSteps) {
  const double share = 0.15, tau = 20;
  GaugeLag<double> lag(share, tau);
  double z = kSignal[0] / (1 + share);
  EXPECT_NEAR(lag.Next(kTimes[0], kSignal[0]), z, 1e-15);
  for (std::size_t i = 1; i < kTimes.size(); ++i) {
    constexpr int kSteps = 200000;
    const double dt = (kTimes[i] - kTimes[i - 1]) / kSteps;
    for (int k = 0; k < kSteps; ++k) {
      const double u =
          kSignal[i - 1] + (kSignal[i] - kSignal[i - 1]) * (k + 0.5) / kSteps;
      z += dt / tau * (u - (1 + share) * z) * (1 - dt * (1 + share) / tau / 2);
    }
    EXPECT_NEAR(lag.Next(kTimes[i], kSignal[i]), z, 1e-7) << i;
  }
}

TEST(GaugeLagTest, DerivativesAgreeWithCentralDifferences) {
  using Jet = ceres::Jet<double, 2>;
  const double share = 0.15, tau = 20, step = 1e-5;
  GaugeLag<Jet> lag(Jet(share, 0), Jet(tau, 1));
  Jet z;
  for (std::size_t i = 0; i < kTimes.size(); ++i) {
    z = lag.Next(kTimes[i], Jet(kSignal[i]));
  }
  EXPECT_NEAR(
      z.v[0],
      (LastLag(share + step, tau) - LastLag(share - step, tau)) / (2 * step),
      1e-8);
  EXPECT_NEAR(
      z.v[1],
      (LastLag(share, tau + step) - LastLag(share, tau - step)) / (2 * step),
      1e-8);
}

TEST(GaugeLagTest, RowsWithoutTimeAndOtherLogs) {
  GaugeLag<double> lag(0, 10);
  EXPECT_EQ(lag.Next(5, 1), 1);
  EXPECT_EQ(lag.Next(std::nan(""), 3), 1);
  EXPECT_EQ(lag.Next(4, 3), 1);
  EXPECT_GT(lag.Next(6, 3), 1);
  lag.Restart();
  EXPECT_EQ(lag.Next(1, -2), -2);
}

}  // namespace
}  // namespace finray
