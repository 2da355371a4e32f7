#include "finray/sensing/fast/contact_step.h"

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

// Where A + B is not positive, a step by it may lead uphill.
TEST(KeepConvexTest, DropsACurvatureThatTurnsTheBowlOver) {
  ContactEquations equations{ContactMatrix::Identity(2, 2),
                             ContactVector::Zero(2), 1,
                             ContactMatrix::Identity(2, 2)};
  equations.curvature *= -0.5;
  KeepConvex(&equations);
  EXPECT_EQ(equations.curvature.rows(), 2);
  equations.curvature(0, 1) = equations.curvature(1, 0) = 0.6;
  KeepConvex(&equations);
  EXPECT_EQ(equations.curvature.size(), 0);
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
