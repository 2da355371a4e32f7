#include "finray/chain/se2.h"

#include <gtest/gtest.h>

#include <random>

#include "chain/jet_jacobian.h"

namespace finray {
namespace {

Eigen::Matrix3d Hat(const Twist<double>& x) {
  Eigen::Matrix3d hat;
  hat << 0, -x[0], x[1], x[0], 0, x[2], 0, 0, 0;
  return hat;
}

Eigen::Matrix3d Matrix(const Pose<double>& g) {
  Eigen::Matrix3d matrix;
  matrix << g.c, -g.s, g.t[0], g.s, g.c, g.t[1], 0, 0, 1;
  return matrix;
}

// exp by its power series, scaled and squared.
Eigen::Matrix3d SeriesExp(const Eigen::Matrix3d& a) {
  const Eigen::Matrix3d small = a / 256;
  Eigen::Matrix3d term = Eigen::Matrix3d::Identity(), sum = term;
  for (int k = 1; k < 20; ++k) {
    term = term * small / k;
    sum += term;
  }
  for (int k = 0; k < 8; ++k) sum = (sum * sum).eval();
  return sum;
}

std::vector<Twist<double>> Twists() {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::vector<Twist<double>> twists;
  for (const double angle : {0.0, 1e-12, -1e-8, 1e-4, 0.0099, -0.0101, 0.06,
                             0.0633, -0.099, 0.101, 0.9, -2.0, 3.1, -3.141}) {
    twists.push_back({angle, 5 * uniform(random), 5 * uniform(random)});
  }
  return twists;
}

TEST(Se2Test, ExpIsThePowerSeries) {
  for (const auto& x : Twists()) {
    EXPECT_LT((Matrix(Exp(x)) - SeriesExp(Hat(x))).norm(), 1e-13) << x[0];
  }
}

TEST(Se2Test, LogUndoesExp) {
  for (const auto& x : Twists()) {
    EXPECT_LT((Log(Exp(x)) - x).norm(), 2e-13) << x[0];
  }
}

TEST(Se2Test, AdjointIsConjugation) {
  for (const auto& x : Twists()) {
    for (const auto& y : Twists()) {
      const Eigen::Matrix3d g = Matrix(Exp(x));
      const Eigen::Matrix3d expected = g * Hat(y) * Matrix(Exp(x).Inverse());
      EXPECT_LT((Hat(Adjoint(Exp(x), y)) - expected).norm(), 1e-12);
      const Eigen::Matrix3d commutator = Hat(x) * Hat(y) - Hat(y) * Hat(x);
      EXPECT_LT((Hat(Bracket(x, y)) - commutator).norm(), 1e-13);
    }
  }
}

TEST(Se2Test, LogJacobianIsTheDerivativeAlongSpatialTwists) {
  for (const auto& x : Twists()) {
    const Pose<double> g = Exp(x);
    const Pose<Jet1> at{Jet1(g.c), Jet1(g.s), g.t.cast<Jet1>()};
    const Eigen::MatrixXd expected = JetJacobian(
        [&](const JetVector& e) -> JetVector {
          return Log(Exp<Jet1>(Twist<Jet1>(e)) * at);
        },
        Eigen::Vector3d::Zero());
    // Near a half turn h cot(h) itself is steep.
    EXPECT_LT(RelativeError(LogJacobian(g), expected), 1e-10) << x[0];
  }
}

TEST(Se2Test, PowerDoesNotDependOnTheOrigin) {
  const Eigen::Vector2d point(3, -2), force(0.7, 1.9), centre(-1, 5);
  const Twist<double> turn = RevoluteTwist<double>(centre);
  EXPECT_NEAR(turn.dot(ForceWrench<double>(point, force)),
              Cross(point - centre, force), 1e-14);
  EXPECT_LT(Velocity<double>(turn, centre).norm(), 1e-15);
}

}  // namespace
}  // namespace finray
