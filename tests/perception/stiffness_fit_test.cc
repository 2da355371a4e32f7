#include "finray/perception/stiffness_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "finray/io/error.h"

namespace finray {
namespace {

ForcePoint PointOf(double u, double force, double std_u, double std_force,
                   double correlation = 0) {
  ForcePoint point{};
  point.displacement_mm = u;
  point.force_N = force;
  point.direction = 1;
  point.slides = true;
  const double mixed = correlation * std_u * std_force;
  point.covariance << std_u * std_u, mixed, mixed, std_force * std_force;
  return point;
}

// Pearson's data with York's weights (D. York, Can. J. Phys. 44, 1966), x
// mirrored so that the line rises: slope 0.480533407, intercept 5.47991022,
// chi2 11.8663532, std of the slope 0.0580 (York et al., Am. J. Phys. 72,
// 2004).
TEST(StiffnessFitTest, IsYorksLine) {
  const double x[] = {0.0, 0.9, 1.8, 2.6, 3.3, 4.4, 5.2, 6.1, 6.5, 7.4};
  const double y[] = {5.9, 5.4, 4.4, 4.6, 3.5, 3.7, 2.8, 2.8, 2.4, 1.5};
  const double wx[] = {1000, 1000, 500, 800, 200, 80, 60, 20, 1.8, 1.0};
  const double wy[] = {1.0, 1.8, 4.0, 8.0, 20, 20, 70, 70, 100, 500};
  std::vector<ForcePoint> points;
  for (int i = 0; i < 10; ++i) {
    points.push_back(
        PointOf(-x[i], y[i], 1 / std::sqrt(wx[i]), 1 / std::sqrt(wy[i])));
  }
  const StiffnessFit fit = FitStiffness(points, 1);
  EXPECT_NEAR(fit.coefficients[1], 0.480533407, 1e-6);
  EXPECT_NEAR(fit.coefficients[0], 5.47991022, 1e-5);
  EXPECT_NEAR(fit.chi2, 11.8663532, 1e-5);
  EXPECT_EQ(fit.dof, 8);
  EXPECT_NEAR(std::sqrt(fit.covariance(1, 1)), 0.0580, 2e-4);
  EXPECT_FALSE(fit.law.has_friction);
}

// With correlated errors in u and F, as one contact has them, the fit has no
// bias and an honest std.
TEST(StiffnessFitTest, StdAndFrictionOverDraws) {
  constexpr double kStiffness = 2, kFriction = 0.15, kStd = 0.05;
  constexpr double kCorrelation = -0.6;
  std::mt19937_64 generator(5);
  std::normal_distribution<double> normal;
  double sum = 0, squares = 0, friction = 0;
  constexpr int kDraws = 200;
  for (int draw = 0; draw < kDraws; ++draw) {
    std::vector<ForcePoint> points;
    for (int i = 0; i < 40; ++i) {
      const double u = 0.05 * (i < 20 ? i : 39 - i);
      const int s = i < 20 ? 1 : -1;
      const double a = normal(generator), b = normal(generator);
      points.push_back(
          PointOf(u + kStd * a,
                  kStiffness * u + s * kFriction +
                      kStd * (kCorrelation * a +
                              std::sqrt(1 - kCorrelation * kCorrelation) * b),
                  kStd, kStd, kCorrelation));
      points.back().direction = s;
    }
    const StiffnessFit fit = FitStiffness(points, 1);
    const Stiffness found = StiffnessBetween(fit, 0.5, 1.5);
    sum += found.N_per_mm;
    const double off = (found.N_per_mm - kStiffness) / found.std;
    squares += off * off;
    friction += fit.friction_N();
  }
  EXPECT_NEAR(sum / kDraws, kStiffness, 0.02);
  EXPECT_NEAR(std::sqrt(squares / kDraws), 1, 0.15);
  EXPECT_NEAR(friction / kDraws, kFriction, 3e-3);
}

TEST(StiffnessFitTest, BentLawsTakeHigherDegrees) {
  std::vector<ForcePoint> points, straight;
  for (int i = 0; i <= 20; ++i) {
    const double u = 0.2 * i;
    points.push_back(PointOf(u, 0.5 * u + 0.2 * u * u, 0.01, 0.01));
    straight.push_back(PointOf(u, 0.5 * u, 0.01, 0.01));
  }
  const StiffnessFit fit = FitStiffness(points, 3);
  EXPECT_EQ(fit.law.degree, 2);
  EXPECT_EQ(FitStiffness(straight, 3).law.degree, 1);
  // From F = 0.7 at u = 1 to F = 1.8 at u = 2.
  EXPECT_NEAR(StiffnessBetween(fit, 0.7, 1.8).N_per_mm, 1.1, 1e-4);
}

// Light touches that read like 50 N, with a std as small as the others.
TEST(StiffnessFitTest, LeavesOutWhatContradictsTheOthers) {
  constexpr double kStiffness = 2, kStd = 0.03;
  std::mt19937_64 generator(8);
  std::normal_distribution<double> normal;
  for (const double model_error : {0.0, 0.3}) {  // N: far above the std
    std::vector<ForcePoint> points, clean;
    for (int i = 0; i < 40; ++i) {
      const double u = 0.1 * i;
      const double wave = model_error * std::sin(1.3 * u);
      clean.push_back(PointOf(u + kStd * normal(generator),
                              kStiffness * u + wave + kStd * normal(generator),
                              kStd, kStd));
      points.push_back(clean.back());
      if (i % 8 == 1) points.back().force_N = 50 + normal(generator);
    }
    const StiffnessFit fit = FitStiffness(points, 1);
    EXPECT_EQ(fit.left_out.size(), 5u) << model_error;
    EXPECT_EQ(fit.points, 35u);
    EXPECT_LT(fit.largest_force_N, 10);
    const StiffnessFit all = FitStiffness(clean, 1);
    EXPECT_TRUE(all.left_out.empty());
    EXPECT_EQ(all.points, 40u);
    EXPECT_NEAR(fit.coefficients[1], all.coefficients[1],
                3 * std::sqrt(fit.covariance(1, 1)));
  }
}

TEST(StiffnessFitTest, FewPointsAreKept) {
  std::vector<ForcePoint> points;
  for (int i = 0; i < 5; ++i) {
    points.push_back(PointOf(i, 2 * i, 0.03, 0.03));
    points.back().direction = i < 3 ? 1 : -1;
  }
  points[1].force_N += 4;
  const StiffnessFit fit = FitStiffness(points, 2);
  EXPECT_EQ(fit.points, 5u);
  EXPECT_TRUE(fit.left_out.empty());
}

// Points with a large std hardly influence which others are left out.
TEST(StiffnessFitTest, UnsurePointsDoNotJudge) {
  std::mt19937_64 generator(9);
  std::normal_distribution<double> normal;
  std::vector<ForcePoint> points;
  for (int i = 0; i < 40; ++i) {
    const double u = 0.1 * i;
    points.push_back(PointOf(u, 2 * u + 0.03 * normal(generator), 0.01, 0.03));
    if (i % 10 == 1) points.back().force_N += 50;
    if (i % 20 == 5) points.back() = PointOf(u, 2 * u + 50, 0.01, 30);
  }
  const StiffnessFit fit = FitStiffness(points, 1);
  EXPECT_EQ(fit.left_out.size(), 4u);
  EXPECT_NEAR(fit.coefficients[1], 2, 0.02);
}

TEST(StiffnessFitTest, RefusesTooFewPointsAndFallingForces) {
  std::vector<ForcePoint> points;
  for (int i = 0; i < 8; ++i) points.push_back(PointOf(i, -i, 0.1, 0.1));
  EXPECT_THROW(FitStiffness(points, 1), InputError);
  points.resize(4);
  EXPECT_THROW(FitStiffness(points, 1), InputError);
}

}  // namespace
}  // namespace finray
