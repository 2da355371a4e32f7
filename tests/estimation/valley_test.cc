#include "finray/estimation/valley.h"

#include <gtest/gtest.h>

#include "estimation/gauge_volts.h"
#include "finray/estimation/frame_estimator.h"
#include "studies/ramps.h"
#include "test_finger.h"

namespace finray {
namespace {

// One place each 10 mm, with chi2 = ((l - 50) / std)^2 up to a limit.
std::vector<ContactStart> Places(double std_mm, double most_chi2) {
  std::vector<ContactStart> places(14);
  for (std::size_t i = 0; i < places.size(); ++i) {
    const double arc = 5 + 10.0 * static_cast<double>(i);
    places[i].contacts[0] = {arc, 2 + 0.01 * (arc - 50), 0};
    places[i].chi2 = std::min(most_chi2, std::pow((arc - 50) / std_mm, 2));
  }
  return places;
}

ContactSolution At50mm() {
  ContactSolution solution;
  solution.count = 1;
  solution.contacts[0] = {50, 2, 0};
  return solution;
}

TEST(ValleyTest, AStraightValleyHasItsStd) {
  EXPECT_FALSE(FindValley(Places(4, 1e9), At50mm(), {4, 0.04}, 1, 140));
  // A std too small by more than the slack.
  const auto valley = FindValley(Places(4, 1e9), At50mm(), {2, 0.02}, 1, 140);
  ASSERT_TRUE(valley);
  EXPECT_NEAR(valley->arc_factor, 2 / kOneContactRule.slack, 0.05);
  EXPECT_NEAR(valley->normal_factor, 2 / kOneContactRule.slack, 0.05);
  EXPECT_NEAR(valley->arc_low_mm, 42, 0.5);
  EXPECT_NEAR(valley->arc_high_mm, 58, 0.5);
  EXPECT_NEAR(valley->normal_high_N, 2.08, 0.005);
}

TEST(ValleyTest, AValleyToTheEndsOfTheFinger) {
  const auto valley = FindValley(Places(4, 3), At50mm(), {4, 0.04}, 1, 140);
  ASSERT_TRUE(valley);
  EXPECT_GT(valley->arc_factor, 5);
  EXPECT_EQ(valley->arc_low_mm, 0);
  EXPECT_EQ(valley->arc_high_mm, 140);
  // Far less likely places do not count.
  EXPECT_FALSE(FindValley(Places(4, 30), At50mm(), {4, 0.04}, 1, 140));
}

struct Frame {
  std::vector<double> volts;
  double arc_mm, normal_N;  // the truth
};

// Frames that a search finds far from their truth, with small std.
TEST(ValleyTest, FramesFarFromTheirTruthAreNotOk) {
  FrameEstimator estimator(PaperFinger(), Scene(), {});
  for (const Frame& frame : std::vector<Frame>{
           // past the last rib
           {{-0.00739, 0.00311, 0.01205, 0.02417}, 130.1, 6.39},
           {{-0.007467, 0.003059, 0.012002, 0.024480}, 127.52, 5.013},
           // light touches that a heavy contact at the tip explains better
           {{-0.001833, 0.000093, 0.002442, 0.002552}, 78.11, 0.222},
           {{-0.002409, 0.000762, 0.003350, 0.004082}, 89.01, 0.284},
           {{-0.001228, -0.000295, 0.001049, 0.001532}, 127.6, 0.372}}) {
    Measurements row;
    row.gauges_V = frame.volts;
    const FrameEstimate estimate = estimator.Estimate(row);
    const ContactEstimate& contact = estimate.contact[0];
    EXPECT_EQ(estimate.status, FrameStatus::kUnobservable) << frame.arc_mm;
    EXPECT_LT(ErrorInStd(estimate, frame.arc_mm, frame.normal_N), 6)
        << contact.arc_mm << " " << contact.normal_N;
    EXPECT_LE(contact.normal_N, estimator.most_force_N());
    EXPECT_LT(contact.arc_low_mm, contact.arc_mm);
    EXPECT_GE(contact.arc_high_mm, contact.arc_mm);
  }
}

// ramp_study has the same on a million frames.
TEST(ValleyTest, RampsFromZero) {
  for (const double peak_N : {0.7, 8.0}) {
    for (const RampTally& band :
         RampStudy(PaperFinger(), Scene(), peak_N, 100, {0, 39, 105, 140}, 2)) {
      EXPECT_EQ(band.beyond_6, 0) << band.from_mm;
      EXPECT_LE(band.beyond_3, 0.01 * band.ok + 2) << band.from_mm;
      if (band.from_mm == 39) {
        EXPECT_GT(band.ok, (peak_N < 1 ? 0.5 : 0.94) * band.frames);
      }
    }
  }
}

TEST(ValleyTest, AnOrdinaryFrameKeepsItsStdAndHasAnIntervalOfTwo) {
  FrameEstimator estimator(PaperFinger(), Scene(), {});
  EquilibriumSolver solver(PaperFinger(), {});
  ASSERT_TRUE(solver.Solve({{70, 3, 0}}));
  const FrameEstimate estimate = estimator.Estimate(CleanReadings(solver));
  EXPECT_FALSE(estimate.valley);
  const ContactEstimate& contact = estimate.contact[0];
  EXPECT_EQ(contact.arc_low_mm, contact.arc_mm - 2 * contact.arc_std_mm);
  EXPECT_EQ(contact.normal_high_N, contact.normal_N + 2 * contact.normal_std_N);
}

// No valley leads to forces beyond the scene's limit.
TEST(ValleyTest, AStatedForceLimitMakesLightTouchesCertain) {
  Scene limited;
  limited.force_max_N = 1;
  const auto ok = [](const Scene& scene) {
    const RampTally band =
        RampStudy(PaperFinger(), scene, 0.7, 60, {83, 105}, 2)[0];
    EXPECT_EQ(band.beyond_6, 0);
    EXPECT_LE(band.beyond_3, 0.01 * band.ok + 2);
    return band.ok;
  };
  EXPECT_GT(ok(limited), 1.5 * ok(Scene()));
}

// No force beyond the scene's limit is a result.
TEST(ValleyTest, ForceMaxBoundsTheForce) {
  Scene scene;
  scene.force_max_N = 2;
  EquilibriumSolver solver(PaperFinger(), {});
  ASSERT_TRUE(solver.Solve({{70, 3, 0}}));
  for (const FrameMethod method :
       {FrameMethod::kFast, FrameMethod::kCeresReduced}) {
    FrameEstimator estimator(PaperFinger(), scene, {}, method);
    const FrameEstimate estimate = estimator.Estimate(CleanReadings(solver));
    EXPECT_LE(estimate.contact[0].normal_N, 2);
    EXPECT_NE(estimate.status, FrameStatus::kOk);
  }
}

}  // namespace
}  // namespace finray
