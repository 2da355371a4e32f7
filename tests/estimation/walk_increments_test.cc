#include "finray/estimation/walk_increments.h"

#include <gtest/gtest.h>

#include <random>

namespace finray {
namespace {

using Verdict = WalkIncrements::Verdict;

// Increments of four gauges over 32 steps of 10 s and their sums, of a walk of
// `scale` times 1 mV in the square root of a second and a drift, as a filter of
// readings that leave a share `open` of the expected variance finds them.
WalkIncrements Of(double scale, double drift_V_per_s, double open = 0) {
  constexpr int kSteps = 32, kGauges = 4;
  const double told = 1 - open;
  std::mt19937_64 generator(1);
  std::normal_distribution<double> normal(0, 1);
  WalkIncrements walk;
  walk.told_V_per_sqrt_s = 1e-3;
  std::vector<Eigen::VectorXd> steps;
  for (int i = 0; i < kSteps; ++i) {
    Eigen::VectorXd& step = steps.emplace_back(kGauges);
    for (double& moved : step) {
      moved = 10 * drift_V_per_s +
              1e-3 * std::sqrt(10 * told * (told * scale * scale + open)) *
                  normal(generator);
    }
  }
  std::size_t lag = 0;
  for (std::size_t of = 1; of <= kSteps; of *= 2, ++lag) {
    for (std::size_t i = 0; i < kSteps; i += of) {
      Eigen::VectorXd moved = Eigen::VectorXd::Zero(kGauges);
      for (std::size_t k = i; k < i + of; ++k) moved += steps[k];
      const double seconds = 10. * static_cast<double>(of);
      walk.Add(
          lag, moved, seconds,
          open * 1e-6 * seconds * Eigen::MatrixXd::Identity(kGauges, kGauges));
    }
  }
  return walk;
}

TEST(WalkIncrementsTest, JudgeTheScaleOfTheWalk) {
  EXPECT_EQ(Of(1, 0).Judge(), Verdict::kFits);
  EXPECT_EQ(Of(1.1, 0).Judge(), Verdict::kFits);
  EXPECT_EQ(Of(0.9, 0).Judge(), Verdict::kFits);
  EXPECT_EQ(Of(3, 0).Judge(), Verdict::kTooSmall);
  EXPECT_NEAR(Of(3, 0).FittingWalk(), 3e-3, 5e-4);
  EXPECT_EQ(Of(0.1, 0).Judge(), Verdict::kTooLarge);
  EXPECT_NEAR(Of(0.1, 0).FittingWalk(), 1e-4, 2e-5);
}

TEST(WalkIncrementsTest, KnowASteadyDriftFromAWalk) {
  const WalkIncrements drift = Of(0.5, 1e-3);
  EXPECT_EQ(drift.Judge(), Verdict::kDrift);
  for (const double moved_V : drift.moved_V) {
    EXPECT_NEAR(moved_V / drift.moved_s, 1e-3, 1e-4);
  }
}

TEST(WalkIncrementsTest, WeighWhatReadingsLeaveOpen) {
  EXPECT_EQ(Of(1, 0, 0.5).Judge(), Verdict::kFits);
  EXPECT_EQ(Of(3, 0, 0.5).Judge(), Verdict::kTooSmall);
  EXPECT_NEAR(Of(3, 0, 0.5).FittingWalk(), 3e-3, 5e-4);
  // Nothing is known of such increments.
  EXPECT_EQ(Of(3, 0, 0.9).Judge(), Verdict::kFits);
  EXPECT_EQ(WalkIncrements().Judge(), Verdict::kFits);
}

TEST(WalkIncrementsTest, OfSeveralLogsAddUp) {
  WalkIncrements both = Of(3, 0);
  both.Add(Of(3, 0));
  EXPECT_EQ(both.told_V_per_sqrt_s, 1e-3);
  EXPECT_EQ(both.dof[0], 2 * 32 * 4);
  EXPECT_EQ(both.Judge(), Verdict::kTooSmall);
  EXPECT_NEAR(both.FittingWalk(), Of(3, 0).FittingWalk(), 1e-12);
}

}  // namespace
}  // namespace finray
