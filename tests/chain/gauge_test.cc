// Both gauge definitions against the exact beam.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "chain/chain_fixture.h"
#include "finray/chain/forward.h"
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
