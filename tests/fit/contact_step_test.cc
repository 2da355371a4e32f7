#include "finray/fit/contact_step.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace finray {
namespace {

constexpr double kMostForce = 40;

// The same minimum by many sweeps over one component after the other.
ContactVector BySweeps(const ContactEquations& equations,
                       const ContactVector& x) {
  ContactVector change = ContactVector::Zero(x.size());
  for (int sweep = 0; sweep < 200'000; ++sweep) {
    for (int k = 0; k < x.size(); ++k) {
      const double slope =
          equations.gradient[k] + equations.normal.row(k).dot(change);
      const bool arc = k % 2 == 0;
      const double low = arc ? std::max(-x[k], -kLongestMove) : -x[k];
      const double high =
          arc ? std::min(1 - x[k], kLongestMove) : kMostForce - x[k];
      change[k] =
          std::clamp(change[k] - slope / equations.normal(k, k), low, high);
    }
  }
  return change;
}

TEST(BoundedChangeTest, IsTheLeastInTheBox) {
  std::mt19937_64 generator(5);
  std::uniform_real_distribution<double> draw(0, 1);
  std::normal_distribution<double> normal;
  int at_bounds = 0;
  for (int i = 0; i < 40; ++i) {
    const int unknowns = i % 2 == 0 ? 2 : 4;
    const Eigen::MatrixXd slopes = Eigen::MatrixXd::NullaryExpr(
        6, unknowns, [&] { return normal(generator); });
    ContactEquations equations;
    equations.normal = slopes.transpose() * slopes;
    equations.gradient =
        slopes.transpose() *
        Eigen::VectorXd::NullaryExpr(6, [&] { return 30 * normal(generator); });
    equations.chi2 = 0;  // no damping of l_c
    ContactVector x(unknowns);
    for (int k = 0; k < unknowns; ++k) {
      x[k] = k % 2 == 0 ? draw(generator) : kMostForce * draw(generator);
    }
    const ContactVector expected = BySweeps(equations, x);
    const ContactVector change = BoundedChange(equations, x, kMostForce, 0);
    EXPECT_LT((change - expected).norm(), 1e-6) << i;
    at_bounds += std::abs(change[0]) == kLongestMove;
  }
  EXPECT_GT(at_bounds, 10);
}

// Two angles that are quadratic in x. The sums are those of chi2 / 2: its
// gradient and its Hessian A + B by differences.
TEST(CurvedSumsTest, AreTheDerivativesOfChi2) {
  constexpr double kWeights[2] = {3, 0.7};
  constexpr double kSecond[2][3] = {{1.3, -0.4, 0.2}, {0.6, 0.9, -0.5}};
  const auto angle = [&](int j, double l, double f) {
    const double* h = kSecond[j];
    return 0.1 + (1 + j) * l - (2 - j) * f +
           (h[0] * l * l + 2 * h[1] * l * f + h[2] * f * f) / 2;
  };
  const auto half_chi2 = [&](double l, double f) {
    double sum = 0;
    for (int j = 0; j < 2; ++j) {
      const double off = kWeights[j] * angle(j, l, f);
      sum += off * off / 2;
    }
    return sum;
  };
  const double l = 0.3, f = 0.2, step = 1e-4;
  CurvedSums sums;
  for (int j = 0; j < 2; ++j) {
    const double* h = kSecond[j];
    sums.Add(kWeights[j], angle(j, l, f), 1 + j + h[0] * l + h[1] * f,
             j - 2 + h[1] * l + h[2] * f, h[0], h[1], h[2]);
  }
  const ContactEquations equations = sums.Equations();
  ASSERT_EQ(equations.curvature.rows(), 2);
  const ContactMatrix hessian = equations.normal + equations.curvature;
  const auto at = [&](int i, int j) {
    return half_chi2(l + i * step, f + j * step);
  };
  EXPECT_NEAR(equations.chi2, 2 * at(0, 0), 1e-12);
  EXPECT_NEAR(equations.gradient[0], (at(1, 0) - at(-1, 0)) / (2 * step), 1e-6);
  EXPECT_NEAR(equations.gradient[1], (at(0, 1) - at(0, -1)) / (2 * step), 1e-6);
  const double square = step * step;
  EXPECT_NEAR(hessian(0, 0), (at(1, 0) - 2 * at(0, 0) + at(-1, 0)) / square,
              1e-5);
  EXPECT_NEAR(hessian(1, 1), (at(0, 1) - 2 * at(0, 0) + at(0, -1)) / square,
              1e-5);
  const double across =
      (at(1, 1) - at(1, -1) - at(-1, 1) + at(-1, -1)) / (4 * square);
  EXPECT_NEAR(hessian(0, 1), across, 1e-5);
  EXPECT_EQ(hessian(0, 1), hessian(1, 0));
}

// Where A + B is not positive, a step by it may lead uphill.
TEST(CurvedSumsTest, LeaveOutACurvatureThatTurnsTheBowlOver) {
  // A is the unit matrix, B is -0.5 and `across` beside the diagonal.
  const auto equations = [](double across) {
    CurvedSums sums;
    sums.Add(1, 1, 1, 0, -0.5, across, -0.5);
    sums.Add(1, 0, 0, 1, 0, 0, 0);
    return sums.Equations();
  };
  EXPECT_EQ(equations(0).curvature.rows(), 2);
  EXPECT_EQ(equations(0.6).curvature.size(), 0);
}

// A force that the gauges do not see goes to its bound and leaves the place to
// be found.
TEST(BoundedChangeTest, OneBoundDoesNotTakeAnotherAlong) {
  ContactEquations equations;
  equations.normal = Eigen::Matrix2d{{2e7, -4}, {-4, 1e-6}};
  equations.gradient = Eigen::Vector2d(1000, -1e-3);
  equations.chi2 = 0.3;
  const Eigen::Vector2d x(0.9999, kMostForce);
  const ContactVector change = BoundedChange(equations, x, kMostForce, 0);
  EXPECT_EQ(change[1], 0);
  EXPECT_NEAR(change[0], -1000 / 2e7, 1e-9);
}

}  // namespace
}  // namespace finray
