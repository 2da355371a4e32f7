#include "finray/estimation/hidden_forces.h"

#include <gtest/gtest.h>

#include <random>

#include "finray/estimation/frame_estimator.h"
#include "studies/gauge_frames.h"
#include "test_finger.h"

namespace finray {
namespace {

// Of the frames that the estimator draws at a place, so many are no_contact.
double ShareHidden(const Finger& finger, double arc_mm, double normal_N) {
  constexpr int kFrames = 300;
  FrameEstimator estimator(finger, {});
  EquilibriumSolver solver(finger, {});
  EXPECT_TRUE(solver.Solve({{arc_mm, normal_N, 0}}));
  const Measurements clean = CleanReadings(solver);
  std::mt19937_64 random(3);
  int hidden = 0;
  for (int i = 0; i < kFrames; ++i) {
    hidden += estimator.Estimate(WithNoise(clean, finger, &random)).status ==
              FrameStatus::kNoContact;
  }
  return static_cast<double>(hidden) / kFrames;
}

TEST(HiddenForcesTest, LargerOnesAreSeen) {
  Finger finger = PaperFinger();
  for (Gauge& gauge : finger.gauges) gauge.noise_V = 3e-4;
  const HiddenForces hidden = FindHiddenForces(finger, {}, {});
  ASSERT_EQ(hidden.contact_mm.size(), 57u);
  ASSERT_EQ(hidden.normal_N.size(), 57u);
  EXPECT_EQ(hidden.contact_mm.front(), 0);
  EXPECT_EQ(hidden.contact_mm.back(), finger.front_length_mm);
  for (const std::size_t i : {2u, 4u, 10u, 28u, 40u, 50u}) {
    const double arc_mm = hidden.contact_mm[i], force_N = hidden.normal_N[i];
    EXPECT_LT(ShareHidden(finger, arc_mm, 1.02 * force_N), 0.08) << arc_mm;
    EXPECT_GT(ShareHidden(finger, arc_mm, 0.7 * force_N), 0.3) << arc_mm;
  }
  // Nothing at the clamp is felt, and 11 N hide at 2.5 mm.
  EXPECT_EQ(hidden.normal_N[0], GaugeTable::HeaviestForce_N(finger));
  EXPECT_GT(hidden.normal_N[1], 8);
  EXPECT_LT(hidden.normal_N[28], 0.1);
}

TEST(HiddenForcesTest, GoWithTheNoiseAndEndAtTheScenesLimit) {
  Finger finger = PaperFinger();
  for (Gauge& gauge : finger.gauges) gauge.noise_V = 3e-4;
  const HiddenForces hidden = FindHiddenForces(finger, {}, {});
  for (Gauge& gauge : finger.gauges) gauge.noise_V = 3e-5;
  Scene scene;
  scene.force_max_N = 5;
  const HiddenForces quiet = FindHiddenForces(finger, scene, {});
  EXPECT_EQ(quiet.normal_N[0], 5);
  for (const std::size_t i : {10u, 28u, 40u}) {
    EXPECT_NEAR(quiet.normal_N[i] / hidden.normal_N[i], 0.1, 0.002);
  }
}

}  // namespace
}  // namespace finray
