#include "finray/chain/elastic_chain.h"

#include <gtest/gtest.h>

#include <cmath>

#include "chain/beam_chain.h"
#include "finray/ladder/rigid_link_element.h"
#include "ladder/computed_element.h"

namespace finray {
namespace {

double Energy(const ElasticChain& beam, const Eigen::VectorXd& theta) {
  return 0.5 * theta.dot(beam.stiffness.cwiseProduct(theta));
}

BeamState Bent(int n, double turn) {
  BeamState state;
  state.theta = Eigen::VectorXd::Constant(n, turn / n);
  return state;
}

// A pure moment bends every joint alike; the links are then chords of a circle
// and the pose follows from the sum of a geometric series.
TEST(BeamChainTest, PureMomentMakesARegularPolygon) {
  const int n = 40;
  const double length = 120, stiffness = 5000, segment = length / n;
  const ElasticChain beam = MakeStraightBeam(length, stiffness, n);
  for (const double turn : {0.3, -1.2, 2.5}) {
    const double each = turn / n;
    // half link, joint, link, joint, .. half link
    Eigen::Vector2d tip(0.5 * segment, 0);
    for (int i = 1; i <= n; ++i) {
      const double share = i < n ? 1 : 0.5;
      tip += share * segment *
             Eigen::Vector2d(std::cos(i * each), std::sin(i * each));
    }
    BeamState state = Bent(n, 0.9 * turn);
    ASSERT_TRUE(SolveBeam(beam, MakePose<double>(turn, tip), &state));
    EXPECT_LT((state.theta.array() - each).abs().maxCoeff(), 1e-11);
    EXPECT_NEAR(state.tip[0], stiffness * turn / length, 1e-9);
    EXPECT_LT(state.tip.tail<2>().norm(), 1e-10);
    // The circle of that curvature, to second order in h.
    const double radius = length / turn;
    const Eigen::Vector2d end(radius * std::sin(turn),
                              radius * (1 - std::cos(turn)));
    EXPECT_LT((tip - end).norm(), length * each * each);
  }
}

// F_t is the gradient of the stored energy by the pose of the held end.
TEST(BeamChainTest, ReactionIsTheGradientOfTheEnergy) {
  const int n = 60;
  const ElasticChain beam = MakeStraightBeam(150, 9000, n);
  const Pose<double> target = MakePose<double>(1.1, {105, 68});
  BeamState state = Bent(n, 1.1);
  ASSERT_TRUE(SolveBeam(beam, target, &state));
  ASSERT_GT(state.tip.tail<2>().norm(), 0.1);
  for (int axis = 0; axis < 3; ++axis) {
    const double step = axis == 0 ? 1e-4 : 1e-2;
    double energy[4];
    for (int k = 0; k < 4; ++k) {
      const double move = step * (k == 0 ? -2 : k == 1 ? -1 : k == 2 ? 1 : 2);
      BeamState moved = state;
      ASSERT_TRUE(SolveBeam(
          beam, Exp<double>(move * Twist<double>::Unit(axis)) * target,
          &moved));
      energy[k] = Energy(beam, moved.theta);
    }
    const double gradient =
        (8 * (energy[2] - energy[1]) - (energy[3] - energy[0])) / (12 * step);
    EXPECT_NEAR(state.tip[axis], gradient, 1e-7 * state.tip.norm());
  }
}

// Clamped at both ends: the internal moment along the beam is what the
// leapfrog integrator carries from the base reaction.
TEST(BeamChainTest, ClampedBeamIsTheLeapfrogMarch) {
  const int n = 80;
  const double length = 150, stiffness = 9000;
  const ElasticChain beam = MakeStraightBeam(length, stiffness, n);
  const Pose<double> target = MakePose<double>(-0.4, {120, -60});
  BeamState state = Bent(n, -0.8);
  ASSERT_TRUE(SolveBeam(beam, target, &state));
  ElementStart at = {0, state.tip[0], state.tip[1], state.tip[2]};
  double x = 0, y = 0;
  for (int i = 0; i < n; ++i) {
    const auto element =
        ComputedElement<RigidLinkElement<>>(at, stiffness, length / n);
    x += element.map().end[0];
    y += element.map().end[1];
    EXPECT_NEAR(element.map().end[2] - at.theta_rad, state.theta[i], 1e-10);
    at.theta_rad = element.map().end[2];
    at.moment_N_mm = element.map().end[3];
  }
  EXPECT_NEAR(x, 120, 1e-8);
  EXPECT_NEAR(y, -60, 1e-8);
  EXPECT_NEAR(at.theta_rad, -0.4, 1e-10);
}

// A cantilever's force is found from the end pose that the linear theory gives
// it: 3 EI w / L^3 and no moment at the tip.
TEST(BeamChainTest, SlightlyBentCantilever) {
  const int n = 200;
  const double length = 100, stiffness = 6000, force = 1e-3;
  const ElasticChain beam = MakeStraightBeam(length, stiffness, n);
  const double w = force * std::pow(length, 3) / (3 * stiffness);
  const double slope = force * length * length / (2 * stiffness);
  // The tip draws back by half the integral of the squared slope.
  const double back = 0.6 * w * w / length;
  BeamState state = Bent(n, slope);
  ASSERT_TRUE(
      SolveBeam(beam, MakePose<double>(slope, {length - back, w}), &state));
  const Eigen::Vector2d end(length - back, w);
  const double moment_at_tip =
      state.tip[0] - Cross(end, Eigen::Vector2d(state.tip.tail<2>()));
  EXPECT_NEAR(state.tip[2], force, 2e-3 * force);
  EXPECT_NEAR(moment_at_tip, 0, 2e-3 * force * length);
}

TEST(BeamChainTest, RefusesAPoseOutOfReach) {
  const ElasticChain beam = MakeStraightBeam(100, 6000, 20);
  BeamState state = Bent(20, 0.5);
  const BeamState before = state;
  EXPECT_FALSE(SolveBeam(beam, MakePose<double>(0, {130, 0}), &state));
  EXPECT_EQ(state.theta, before.theta);
  state = Bent(20, std::nan(""));
  EXPECT_FALSE(SolveBeam(beam, MakePose<double>(0.3, {90, 20}), &state));
}

}  // namespace
}  // namespace finray
