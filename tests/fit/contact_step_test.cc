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

ContactBounds Box(int unknowns) {
  ContactBounds box{ContactVector::Zero(unknowns),
                    ContactVector::Ones(unknowns)};
  for (int k = 1; k < unknowns; k += 2) box.high[k] = kMostForce;
  return box;
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
    const ContactVector change = BoundedChange(equations, x, Box(unknowns), 0);
    EXPECT_LT((change - expected).norm(), 1e-6) << i;
    at_bounds += std::abs(change[0]) == kLongestMove;
  }
  EXPECT_GT(at_bounds, 10);
}

// The others are the least squares without the held component.
TEST(BoundedChangeTest, EqualBoundsHold) {
  ContactEquations equations;
  equations.normal = Eigen::Matrix2d{{4, 1}, {1, 2}};
  equations.gradient = Eigen::Vector2d(-0.1, -0.2);
  equations.chi2 = 0;
  const Eigen::Vector2d x(0.5, 1);
  ContactBounds box = Box(2);
  box.low[0] = box.high[0] = 0.5;
  const ContactVector change = BoundedChange(equations, x, box, 0);
  EXPECT_EQ(change[0], 0);
  EXPECT_NEAR(change[1], 0.1, 1e-8);
}

// r = (x^2 + y, 2 y) / 10 - 1 in x and y: the secant B maps each step to the
// change of the slopes, times r.
TEST(UpdateCurvatureTest, MapsTheStepToTheChangeOfTheSlopes) {
  const auto residuals = [](const ContactVector& x) {
    return Eigen::Vector2d(x[0] * x[0] / 10 + x[1] / 10 - 1, x[1] / 5 - 1);
  };
  const auto slopes = [](const ContactVector& x) {
    Eigen::Matrix2d s;
    s << x[0] / 5, 0.1, 0, 0.2;
    return s;
  };
  const auto gradient = [&](const ContactVector& s, const ContactVector& r) {
    return ContactVector(slopes(s).transpose() * residuals(r));
  };
  ContactMatrix curvature = ContactMatrix::Zero(2, 2);
  ContactVector from(2), to(2);
  from << 3.5, 2.1;
  for (const auto& [x, y] : {std::pair(3.3, 2.3), std::pair(3.2, 2.7)}) {
    to << x, y;
    const ContactVector step = to - from;
    UpdateCurvature(step, gradient(from, from), gradient(from, to),
                    gradient(to, to), &curvature);
    const Eigen::Vector2d expected =
        (slopes(to) - slopes(from)).transpose() * residuals(to);
    EXPECT_LT((curvature * step - expected).norm(), 1e-12);
    EXPECT_NEAR(curvature(0, 1), curvature(1, 0), 1e-15);
    from = to;
  }
}

// A force that the gauges do not see goes to its bound and leaves the place to
// be found.
TEST(BoundedChangeTest, OneBoundDoesNotTakeAnotherAlong) {
  ContactEquations equations;
  equations.normal = Eigen::Matrix2d{{2e7, -4}, {-4, 1e-6}};
  equations.gradient = Eigen::Vector2d(1000, -1e-3);
  equations.chi2 = 0.3;
  const Eigen::Vector2d x(0.9999, kMostForce);
  const ContactVector change = BoundedChange(equations, x, Box(2), 0);
  EXPECT_EQ(change[1], 0);
  EXPECT_NEAR(change[0], -1000 / 2e7, 1e-9);
}

}  // namespace
}  // namespace finray
