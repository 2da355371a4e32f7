#include "finray/sensing/fast/frame_follower.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "finray/sensing/frame_estimator.h"
#include "sensing/uncertain_finger.h"
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

// A fit that follows starts elsewhere than a search, so its last digits differ.
bool Differ(const FrameEstimate& one, const FrameEstimate& other) {
  return one.contact[0].arc_mm != other.contact[0].arc_mm ||
         one.contact[0].normal_N != other.contact[0].normal_N;
}

// Readings of a finger with other gains and beams leave a chi2 that noise does
// not reach. They are followed too, and come out as a search finds them.
TEST(FrameFollowerTest, FramesThatNothingExplainsAgreeWithSearches) {
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
  int unexplained = 0, followed = 0;
  for (std::size_t i = 0; i < log.size(); ++i) {
    const int frame = static_cast<int>(i);
    const FrameEstimate searched = alone.Estimate(log[i]);
    ExpectSame(estimates[i], searched, frame);
    ExpectSame(live.Next(log[i]), searched, frame);
    if (!(searched.p_value() < FrameEstimate::kUnexplained)) continue;
    ++unexplained;
    followed += Differ(estimates[i], searched);
  }
  std::printf("%d frames unexplained, at least %d of them followed\n",
              unexplained, followed);
  EXPECT_GT(unexplained, 100);
  EXPECT_GT(followed, 50);
}

TEST(FrameFollowerTest, BlocksAndLiveFramesAgreeWithSearches) {
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
    int followed = 0;
    for (std::size_t i = 0; i < log.size(); ++i) {
      const int frame = static_cast<int>(i);
      const FrameEstimate searched = alone.Estimate(log[i]);
      ExpectSame(estimates[i], searched, frame);
      ExpectSame(live.Next(log[i]), searched, frame);
      followed += Differ(estimates[i], searched);
    }
    std::printf("noise %g rad: at least %d of %zu frames followed\n", noise,
                followed, log.size());
    EXPECT_GT(followed, 100);
  }
}

// Two gauges leave no degree of freedom and so no p-value.
TEST(FrameFollowerTest, FollowsWithTwoGauges) {
  Finger finger = PaperFinger();
  finger.gauges.resize(2);
  EquilibriumSolver solver(finger, {});
  std::vector<Measurements> log(64);
  for (int i = 0; i < 64; ++i) {
    ASSERT_TRUE(solver.Solve({{60 + 0.1 * i, 3, 0}}));
    for (int j = 0; j < 2; ++j) {
      log[i].gauges_V.push_back(solver.gauge_angle(j));
    }
  }
  FrameEstimator block(finger, {}, {}), alone(finger, {}, {});
  std::vector<FrameEstimate> estimates(log.size());
  block.EstimateBlock(log.data(), log.size(), estimates.data());
  int shorter = 0, ok = 0;
  for (std::size_t i = 0; i < log.size(); ++i) {
    const FrameEstimate searched = alone.Estimate(log[i]);
    ExpectSame(estimates[i], searched, static_cast<int>(i));
    ok += searched.status == FrameStatus::kOk;
    shorter += estimates[i].iterations < searched.iterations;
  }
  std::printf("two gauges: %d ok, %d followed\n", ok, shorter);
  EXPECT_GT(ok, 32);
  EXPECT_GT(shorter, ok / 2);
}

}  // namespace
}  // namespace finray
