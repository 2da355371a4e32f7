// Every block of (5), (13) and (21) to (28) against automatic differentiation.

#include "finray/chain/finger_equations.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <random>

#include "chain/beam_chain.h"
#include "chain/chain_fixture.h"
#include "chain/jet_jacobian.h"

namespace finray {
namespace {

Eigen::VectorXd Random(int size, double scale, std::mt19937* random) {
  std::uniform_real_distribution<double> uniform(-scale, scale);
  Eigen::VectorXd x(size);
  for (double& value : x) value = uniform(*random);
  return x;
}

// n joint angles, then loads: a moment and forces.
Eigen::VectorXd RandomUnknowns(int n, int loads, std::mt19937* random) {
  Eigen::VectorXd x = Random(n + loads, 1, random);
  x.head(n) *= 0.15;
  x[n] *= 200;
  for (int i = n + 1; i < n + loads; ++i) x[i] *= 5;
  return x;
}

TEST(ChainJacobianTest, BeamMatchesAutoDiff) {
  std::mt19937 random(2);
  const int n = 17;
  const ElasticChain beam = MakeStraightBeam(90, 4000, n);
  const Pose<double> target = MakePose<double>(0.7, {70, 30});
  for (int trial = 0; trial < 10; ++trial) {
    const Eigen::VectorXd x = RandomUnknowns(n, 3, &random);
    const Eigen::MatrixXd expected = JetJacobian(
        [&](const JetVector& z) -> JetVector {
          return BeamEquations<Jet1>(beam, target, z.data(), z.tail<3>());
        },
        x);
    const Eigen::MatrixXd jacobian =
        BeamJacobian(beam, target, x.head(n), x.tail<3>());
    EXPECT_LT(RelativeError(jacobian.topRows(3), expected.topRows(3)), 1e-12);
    EXPECT_LT(
        RelativeError(jacobian.block(3, 0, n, n), expected.block(3, 0, n, n)),
        1e-12);
    EXPECT_LT(RelativeError(jacobian.rightCols(3), expected.rightCols(3)),
              1e-12);
  }
}

// (5) has J_t for dy/dtheta, which holds where the tip is on target.
TEST(ChainJacobianTest, PrintedTipBlockHoldsOnTarget) {
  std::mt19937 random(3);
  const ElasticChain beam = MakeStraightBeam(90, 4000, 12);
  const Eigen::VectorXd theta = Random(12, 0.2, &random);
  const auto poses = Kinematics(beam, theta.data());
  const Pose<double> here = TipPose(beam, poses);
  EXPECT_LT(RelativeError(TipDeviationJacobian(beam, poses, here), poses.xi),
            1e-13);
  const Pose<double> away = here * MakePose<double>(0.3, {5, 2});
  EXPECT_GT(RelativeError(TipDeviationJacobian(beam, poses, away), poses.xi),
            1e-2);
}

TEST(ChainJacobianTest, FingerMatchesAutoDiff) {
  std::mt19937 random(4);
  const ChainLayout layout =
      MakeChainLayout(RichFinger(), 30, GaugeRule::kOverlap, {71.3});
  const int n = layout.joints(), loads = layout.loads();
  const int r = static_cast<int>(layout.ribs.size());
  double worst = 0;
  for (int trial = 0; trial < 12; ++trial) {
    Eigen::VectorXd x = RandomUnknowns(n, loads + 2, &random);
    std::uniform_real_distribution<double> arc(1, 139), force(0.1, 8);
    x[n + loads] = arc(random);
    x[n + loads + 1] = force(random);
    const double friction = trial % 3 == 0 ? 0 : 0.3 * (trial % 3);
    const Eigen::MatrixXd expected = JetJacobian(
        [&](const JetVector& z) -> JetVector {
          return FingerEquations<Jet1>(layout, z.data(), z.data() + n,
                                       z.data() + n + loads, friction);
        },
        x);
    const Eigen::MatrixXd jacobian = FingerJacobian(
        layout, x.data(), x.data() + n, x.data() + n + loads, friction);
    // Row blocks y, tau, d; column blocks theta, F_t, f, l_c, f_c.
    const int rows[] = {0, 3, 3 + n, 3 + n + r};
    const int columns[] = {
        0, n, n + 3, n + loads, n + loads + 1, n + loads + 2};
    for (int a = 0; a < 3; ++a) {
      for (int b = 0; b < 5; ++b) {
        const auto block = [&](const Eigen::MatrixXd& of) {
          return of.block(rows[a], columns[b], rows[a + 1] - rows[a],
                          columns[b + 1] - columns[b]);
        };
        const double error = RelativeError(block(jacobian), block(expected));
        EXPECT_LT(error, 1e-9) << "block " << a << ", " << b;
        worst = std::max(worst, error);
      }
    }
  }
  std::printf("worst relative error of a block: %.1e\n", worst);
}

// The single terms of (22), (23), (26) and (27), each alone.
TEST(ChainJacobianTest, SingleTermsMatchAutoDiff) {
  std::mt19937 random(5);
  const ChainLayout layout =
      MakeChainLayout(RichFinger(), 24, GaugeRule::kOverlap);
  const int n = layout.joints(), loads = layout.loads();
  const Eigen::VectorXd theta = Random(n, 0.15, &random);
  for (int which = 0; which < loads + 1; ++which) {
    Eigen::VectorXd load = Eigen::VectorXd::Zero(loads);
    Eigen::Vector2d contact(83.7, 0);
    (which < loads ? load[which] : contact[1]) = 2.3;
    const Eigen::MatrixXd expected = JetJacobian(
        [&](const JetVector& z) -> JetVector {
          const JetVector f = load.cast<Jet1>();
          const JetVector c = contact.cast<Jet1>();
          return FingerEquations<Jet1>(layout, z.data(), f.data(), c.data(),
                                       0.2)
              .segment(3, n);
        },
        theta);
    Eigen::MatrixXd jacobian =
        FingerJacobian(layout, theta.data(), load.data(), contact.data(), 0.2)
            .block(3, 0, n, n);
    // Without K, which would hide the rest.
    jacobian.diagonal() -= layout.chain.stiffness;
    Eigen::MatrixXd rest = expected;
    rest.diagonal() -= layout.chain.stiffness;
    EXPECT_LT(RelativeError(jacobian, rest), 1e-9) << "load " << which;
  }
}

TEST(ChainJacobianTest, ScaledRowsAreThoseOfTheEquations) {
  std::mt19937 random(6);
  const ChainLayout layout =
      MakeChainLayout(RichFinger(), 24, GaugeRule::kOverlap);
  const int n = layout.joints(), loads = layout.loads();
  const Eigen::VectorXd theta = Random(n, 0.1, &random);
  const Eigen::VectorXd load = Random(loads, 4, &random);
  const Eigen::Vector2d contact(50.2, 3);
  const Eigen::Vector4d s0(0.1, -0.2, 0.05, 0);
  const ScaledEquations scaled{layout, 0.2, 7, s0, 0.5};
  const Eigen::VectorXd c =
      scaled.Residual(theta.data(), load.data(), contact.data());
  const Eigen::MatrixXd jacobian =
      scaled.Jacobian(theta.data(), load.data(), contact.data());
  const Eigen::VectorXd model = FingerEquations<double>(
      layout, theta.data(), load.data(), contact.data(), 0.2);
  const Eigen::MatrixXd by =
      FingerJacobian(layout, theta.data(), load.data(), contact.data(), 0.2);
  const double length = layout.length_unit_mm, force = layout.force_unit_N;
  const auto check = [&](int row, double unit) {
    EXPECT_NEAR(c[row], 7 * model[row] / unit, 1e-14 * std::abs(c[row]));
    EXPECT_LT(RelativeError(jacobian.row(row), 7 / unit * by.row(row)), 1e-14);
  };
  check(0, 1);
  check(1, length);
  check(3, force * length);
  check(3 + n, length);
  ASSERT_EQ(c.size(), n + loads + 4);
  EXPECT_LT(RelativeError(c.tail(4), (layout.gauges * theta - s0) / 0.5),
            1e-14);
  EXPECT_LT(RelativeError(jacobian.bottomLeftCorner(4, n), layout.gauges / 0.5),
            1e-14);
  EXPECT_TRUE(jacobian.bottomRightCorner(4, loads + 2).isZero(0));
}

}  // namespace
}  // namespace finray
