#include "finray/chain/chain_layout.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "chain/chain_fixture.h"
#include "finray/chain/forward.h"
#include "finray/io/error.h"
#include "finray/statics/equilibrium.h"

namespace finray {
namespace {

constexpr int kResolutions[] = {40, 80, 160, 320};

// The largest gauge error over a grid of contacts, rad.
double LargestError(int resolution, GaugeRule rule) {
  const Finger finger = PaperFinger();
  EquilibriumSolver exact(finger, {Scheme::kTaylor, 0});
  double worst = 0;
  for (const double arc : {30.0, 50.0, 72.4, 100.0}) {
    for (const double force : {2.0, 8.0}) {
      EXPECT_TRUE(exact.Solve({{arc, force, 0}}));
      const ChainLayout layout =
          MakeChainLayout(finger, resolution, rule, {arc});
      ChainState state;
      EXPECT_TRUE(SolveForward(layout, {arc, force, 0}, &state));
      const Eigen::VectorXd angles = layout.gauges * state.theta;
      for (int j = 0; j < angles.size(); ++j) {
        worst = std::max(worst, std::abs(angles[j] - exact.gauge_angle(j)));
      }
    }
  }
  return worst;
}

TEST(ChainLayoutTest, RunsFromTheFrontBaseOverTheTipToTheBackBase) {
  const ChainLayout layout =
      MakeChainLayout(PaperFinger(), 60, GaugeRule::kOverlap);
  const int n = layout.joints();
  const int front = static_cast<int>(layout.front_joint_mm.size());
  const auto joint = [&](int i) {
    return Eigen::Vector2d(-layout.chain.twists(2, i),
                           layout.chain.twists(1, i));
  };
  for (int i = 0; i < n; ++i) {
    EXPECT_EQ(joint(i).x() > 1e-9, i >= front) << i;
    if (i + 1 == front || i + 1 == n) continue;
    // Up in front, down behind.
    EXPECT_EQ(joint(i + 1).y() > joint(i).y(), i < front) << i;
  }
  EXPECT_NEAR(layout.target.t.x(), 56.5637, 1e-4);
  EXPECT_EQ(layout.target.t.y(), 0);
  // Compliance adds up to that of both beams.
  EXPECT_NEAR(layout.chain.stiffness.cwiseInverse().sum(),
              (140 + 140 / std::sin(112 * M_PI / 180)) / 12500, 1e-13);
  for (const ChainRib& rib : layout.ribs) {
    // The rib's hinges lie between the joints before and after them.
    const int l = rib.joints_before_left, r = rib.joints_before_right;
    EXPECT_LT(joint(l - 1).y(), rib.left.y());
    EXPECT_GT(joint(l).y(), rib.left.y());
    EXPECT_GT(joint(r - 1).y(), rib.right.y());
    EXPECT_LT(joint(r).y(), rib.right.y());
  }
}

TEST(ChainLayoutTest, SplitsASegment) {
  const Finger finger = PaperFinger();
  const ChainLayout plain = MakeChainLayout(finger, 60, GaugeRule::kOverlap);
  const ChainLayout split =
      MakeChainLayout(finger, 60, GaugeRule::kOverlap, {72.4});
  EXPECT_EQ(split.joints(), plain.joints() + 1);
  EXPECT_NEAR(split.chain.stiffness.cwiseInverse().sum(),
              plain.chain.stiffness.cwiseInverse().sum(), 1e-14);
  // On a rib, at an end or twice in a place there is nothing to split.
  EXPECT_EQ(
      MakeChainLayout(finger, 60, GaugeRule::kOverlap, {0, 61, 140}).joints(),
      plain.joints());
  EXPECT_EQ(
      MakeChainLayout(finger, 60, GaugeRule::kOverlap, {72.4, 72.4}).joints(),
      split.joints());
}

TEST(ChainLayoutTest, GaugeRulesCountWholeJointsOrShares) {
  Finger finger = PaperFinger();
  finger.gauges[0].beam = Side::kFront;
  const ChainLayout whole = MakeChainLayout(finger, 60, GaugeRule::kWholeJoint);
  const ChainLayout overlap = MakeChainLayout(finger, 60, GaugeRule::kOverlap);
  for (int j = 0; j < 4; ++j) {
    const double sign = j == 0 ? 1 : -1;
    double covered = 0;
    for (int i = 0; i < whole.joints(); ++i) {
      const double w = sign * whole.gauges(j, i);
      const double o = sign * overlap.gauges(j, i);
      EXPECT_TRUE(w == 0 || w == 1);
      EXPECT_TRUE(o >= 0 && o <= 1 + 1e-12);
      covered += o * 12500 / overlap.chain.stiffness[i];
    }
    EXPECT_NEAR(covered, 18, 1e-10);
  }
}

TEST(ChainLayoutTest, RefusesBadArguments) {
  Finger finger = PaperFinger();
  EXPECT_THROW(MakeChainLayout(finger, 0, GaugeRule::kOverlap), InputError);
  EXPECT_THROW(MakeChainLayout(finger, 60, GaugeRule::kOverlap, {141}),
               InputError);
  EXPECT_THROW(MakeChainLayout(finger, 60, GaugeRule::kOverlap, {std::nan("")}),
               InputError);
  finger.back_axial_stiffness_N = 1e6;
  EXPECT_THROW(MakeChainLayout(finger, 60, GaugeRule::kOverlap), InputError);
}

// Both gauge definitions against the exact beam.
TEST(ChainLayoutTest, RefusesSpringsAtHinges) {
  Finger finger = PaperFinger();
  finger.ribs[2].back_hinge_N_mm_per_rad = 5;
  EXPECT_THROW(MakeChainLayout(finger, 60, GaugeRule::kOverlap), InputError);
}

TEST(ChainGaugeTest, WholeJointGaugeStalls) {
  double whole[4], overlap[4];
  std::printf("   n   whole joints   overlap    (largest error, rad)\n");
  for (int i = 0; i < 4; ++i) {
    whole[i] = LargestError(kResolutions[i], GaugeRule::kWholeJoint);
    overlap[i] = LargestError(kResolutions[i], GaugeRule::kOverlap);
    std::printf("%4d   %.2e       %.2e\n", kResolutions[i], whole[i],
                overlap[i]);
  }
  for (int i = 0; i < 4; ++i) EXPECT_GT(whole[i], 3e-4);
  // Meshes at ribs are not quite nested: the order over all three halvings.
  const double order = std::log2(overlap[0] / overlap[3]) / 3;
  std::printf("order of the overlap-weighted gauge: %.2f\n", order);
  EXPECT_GT(order, 1.7);
  EXPECT_LT(order, 2.4);
  EXPECT_LT(overlap[3], 1e-4);
}

}  // namespace
}  // namespace finray
