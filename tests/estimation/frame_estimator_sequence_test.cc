#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "estimation/uncertain_finger.h"
#include "finray/estimation/frame_estimator.h"
#include "test_finger.h"

namespace finray {
namespace {

// A log that slides, jumps, lets go, loses a gauge and presses lightly.
std::vector<Measurements> MixedLog(double noise_rad) {
  EquilibriumSolver solver(PaperFinger(), {});
  std::mt19937_64 generator(21);
  std::normal_distribution<double> noise(0, noise_rad);
  std::vector<Measurements> log;
  for (int i = 0; i < 512; ++i) {
    double arc = 70 + 45 * std::sin(0.03 * i);
    double force = 4 + 3.5 * std::cos(0.05 * i);
    if (i % 100 == 60) arc = 30;            // for one frame
    if (i % 128 > 110) force = 0;           // let go
    if (i > 300 && i < 340) force *= 0.05;  // lightly
    EXPECT_TRUE(solver.Solve({{arc, force, 0}}));
    Measurements& readings = log.emplace_back();
    for (int j = 0; j < 4; ++j) {
      readings.gauges_V.push_back(solver.gauge_angle(j) + noise(generator));
    }
    if (i % 37 == 5) readings.gauges_V[i % 4] = std::nan("");
  }
  return log;
}

void ExpectSame(const FrameEstimate& one, const FrameEstimate& other, int i) {
  ASSERT_EQ(one.status, other.status) << i;
  ASSERT_EQ(one.contacts, other.contacts) << i;
  EXPECT_EQ(one.dof, other.dof) << i;
  if (one.contacts == 0) return;
  const ContactEstimate &a = one.contact[0], &b = other.contact[0];
  // Both estimates are minima, found to a hundredth of a std.
  EXPECT_NEAR(a.arc_mm, b.arc_mm, 1e-2 * b.arc_std_mm + 1e-4) << i;
  EXPECT_NEAR(a.normal_N, b.normal_N, 1e-2 * b.normal_std_N + 1e-5) << i;
  EXPECT_NEAR(a.arc_std_mm / b.arc_std_mm, 1, 2e-2) << i;
  EXPECT_NEAR(one.chi2, other.chi2, 1e-3 + 1e-3 * other.chi2) << i;
  EXPECT_NEAR((a.pose - b.pose).norm(), 0, 1e-2 * b.arc_std_mm + 2e-4) << i;
  EXPECT_NEAR((one.tip_pose - other.tip_pose).norm(), 0, 1e-2) << i;
  for (int r = 0; r < 5; ++r) {
    EXPECT_NEAR(one.rib_tension_N[r], other.rib_tension_N[r], 1e-2) << i;
  }
}

// Readings of a finger with other gains and beams leave a chi2 that noise does
// not reach.
TEST(FrameEstimatorSequenceTest, FramesThatNothingExplainsAgreeWithSearches) {
  Finger finger = PaperFinger();
  finger.front_stiffness_N_mm2 *= 1.03;
  double sign = 1;
  for (Gauge& gauge : finger.gauges) {
    gauge.noise_V = 1e-4;
    gauge.gain_V_per_rad *= 1 + sign * 0.02;
    sign = -sign;
  }
  Scene scene;
  scene.contacts = 1;
  const std::vector<Measurements> log = MixedLog(1e-4);
  FrameEstimator block(finger, scene, {}), live(finger, scene, {}),
      alone(finger, scene, {});
  std::vector<FrameEstimate> estimates(log.size());
  block.EstimateBlock(log.data(), log.size(), estimates.data());
  int unexplained = 0;
  for (std::size_t i = 0; i < log.size(); ++i) {
    const int frame = static_cast<int>(i);
    const FrameEstimate searched = alone.Estimate(log[i]);
    ExpectSame(estimates[i], searched, frame);
    ExpectSame(live.Next(log[i]), searched, frame);
    if (!(searched.p_value() < FrameEstimate::kUnexplained)) continue;
    ++unexplained;
  }
  EXPECT_GT(unexplained, 100);
}

TEST(FrameEstimatorSequenceTest, BlocksAndLiveFramesAgreeWithSearches) {
  for (const double noise : {1e-4, 3e-4}) {
    Finger finger = PaperFinger();
    for (Gauge& gauge : finger.gauges) gauge.noise_V = noise;
    if (noise == 3e-4) finger.calibration = TypicalCovariance(finger);
    const std::vector<Measurements> log = MixedLog(noise);
    FrameEstimator block(finger, {}, {}), live(finger, {}, {}),
        alone(finger, {}, {});
    std::vector<FrameEstimate> estimates(log.size());
    for (std::size_t i = 0; i < log.size(); i += 64) {
      block.EstimateBlock(&log[i], 64, &estimates[i]);
    }
    for (std::size_t i = 0; i < log.size(); ++i) {
      const int frame = static_cast<int>(i);
      const FrameEstimate searched = alone.Estimate(log[i]);
      ExpectSame(estimates[i], searched, frame);
      ExpectSame(live.Next(log[i]), searched, frame);
    }
  }
}

}  // namespace
}  // namespace finray
