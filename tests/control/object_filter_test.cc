#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "finray/control/model_controller.h"

namespace finray {
namespace {

constexpr double kPeriod_s = 1.0 / 30;

TEST(ObjectFilterTest, FollowsAConstantSpeed) {
  ObjectFilter filter({10, 0, 0}, kPeriod_s);
  for (int k = 0; k < 120; ++k) {
    filter.Predict();
    filter.Update(5 + 3 * k * kPeriod_s, 6, 0.05);
  }
  EXPECT_NEAR(filter.velocity_mm_s(), 3, 1e-4);
  EXPECT_NEAR(filter.PlaceIn(0.2), 5 + 3 * (119 * kPeriod_s + 0.2), 1e-4);
  EXPECT_EQ(filter.compliance_mm_per_N(), 0);
}

// A varying force separates o and c in z = o - c F.
TEST(ObjectFilterTest, LearnsTheCompliance) {
  ObjectFilter filter({10, 0.5, 0}, kPeriod_s);
  std::mt19937_64 generator(1);
  std::normal_distribution<double> noise(0, 0.05);
  for (int k = 0; k < 600; ++k) {
    const double force = 4 + 2 * std::sin(2 * M_PI * k * kPeriod_s / 3);
    filter.Predict();
    filter.Update(-20 - 1.25 * force + noise(generator), force, 0.05);
  }
  EXPECT_NEAR(filter.compliance_mm_per_N(), 1.25, 0.05);
  EXPECT_NEAR(filter.PlaceIn(0), -20, 0.2);
}

TEST(ObjectFilterTest, ComplianceIsNotNegative) {
  ObjectFilter filter({10, 0.5, 0}, kPeriod_s);
  for (int k = 0; k < 100; ++k) {
    const double force = 4 + 2 * std::sin(0.3 * k);
    filter.Predict();
    filter.Update(0.2 * force, force, 0.05);
    EXPECT_GE(filter.compliance_mm_per_N(), 0);
  }
}

// The errors of the place agree with the covariance, over 200 motions with the
// acceleration of the prior.
TEST(ObjectFilterTest, CovarianceIsHonest) {
  std::mt19937_64 generator(2);
  std::normal_distribution<double> unit;
  double sum = 0;
  constexpr int kMotions = 200;
  for (int motion = 0; motion < kMotions; ++motion) {
    ObjectFilter filter({10, 0, 0}, kPeriod_s);
    double place = 0, velocity = 3 * unit(generator);
    for (int k = 0; k < 60; ++k) {
      if (k > 0) {
        const double a = 10 * unit(generator);
        place += velocity * kPeriod_s + 0.5 * a * kPeriod_s * kPeriod_s;
        velocity += a * kPeriod_s;
      }
      filter.Predict();
      filter.Update(place + 0.1 * unit(generator), 6, 0.1);
    }
    const double error = filter.PlaceIn(0) - place;
    sum += error * error / filter.covariance()(0, 0);
  }
  // chi2 with 200 degrees of freedom, over 200, has the std 0.1.
  EXPECT_NEAR(sum / kMotions, 1, 0.3);
}

TEST(ObjectFilterTest, RestartKeepsTheCompliance) {
  ObjectFilter filter({10, 0.5, 0}, kPeriod_s);
  for (int k = 0; k < 300; ++k) {
    const double force = 4 + 2 * std::sin(0.3 * k);
    filter.Predict();
    filter.Update(-force, force, 0.02);
  }
  const double compliance = filter.compliance_mm_per_N();
  filter.Restart();
  EXPECT_FALSE(filter.started());
  filter.Update(7, 2, 0.02);
  EXPECT_EQ(filter.compliance_mm_per_N(), compliance);
  EXPECT_NEAR(filter.PlaceIn(0), 7 + 2 * compliance, 1e-12);
  EXPECT_EQ(filter.velocity_mm_s(), 0);
}

}  // namespace
}  // namespace finray
