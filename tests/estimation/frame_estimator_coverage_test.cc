// The claims of docs/evidence/accuracy.md about std, on fewer frames.

#include <gtest/gtest.h>

#include "studies/coverage.h"

namespace finray {
namespace {

constexpr double kNoises_rad[] = {1e-4, 3e-4};

struct Pooled {
  ErrorTally arc, force;
  std::vector<double> p_values;
  int cells = 0, not_ok = 0;
};

// Pools all cells that are local by height. The last element pools all heights.
std::vector<Pooled> ByHeight(double noise_rad, const std::vector<double>& arcs,
                             int repeats) {
  const Finger finger = PaperFingerWithNoise(noise_rad);
  const std::vector<double> forces = {1, 2, 3, 4, 6, 8};
  const auto cells = CoverageStudy(finger, arcs, forces, repeats, 2);
  std::vector<Pooled> pooled(arcs.size() + 1);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (!cells[i].local(finger.front_length_mm)) continue;
    for (Pooled* to : {&pooled[i / forces.size()], &pooled.back()}) {
      to->arc.Add(cells[i].arc);
      to->force.Add(cells[i].force);
      to->p_values.insert(to->p_values.end(), cells[i].p_values.begin(),
                          cells[i].p_values.end());
      ++to->cells;
      to->not_ok += cells[i].not_ok;
    }
  }
  return pooled;
}

TEST(FrameEstimatorCoverageTest, ErrorsFollowTheStdAtEveryHeight) {
  for (const double noise_rad : kNoises_rad) {
    const auto pooled = ByHeight(noise_rad, Range(25, 108, 8), 350);
    for (const Pooled& height : pooled) {
      EXPECT_GE(height.cells, 2);
      for (const ErrorTally& tally : {height.arc, height.force}) {
        EXPECT_NEAR(tally.share_1(), 0.683, 0.03);
        EXPECT_NEAR(tally.share_196(), 0.95, 0.02);
        EXPECT_NEAR(tally.bias(), 0, 0.2);
        // Neither wider nor narrower than the information allows.
        EXPECT_NEAR(tally.spread(), 1, 0.1);
      }
    }
    EXPECT_GE(pooled.back().cells, 40);
    // Where another place is 8 std away, noise brings it within
    // Valley::kFarthest now and then.
    EXPECT_LT(pooled.back().not_ok, 4e-3 * pooled.back().arc.frames);
    EXPECT_LT(KolmogorovSmirnov(pooled.back().p_values), 1.63);
  }
}

TEST(FrameEstimatorCoverageTest, WrongNoiseIsSeen) {
  // The test above must fail for half the std, and for the chi2 of twice the
  // noise.
  EXPECT_GT(KolmogorovSmirnov(std::vector<double>(100, 0.9)), 5);
  const Finger finger = PaperFingerWithNoise(1e-4);
  Finger optimist = finger;
  for (Gauge& gauge : optimist.gauges) gauge.noise_V = 0.8e-4;
  Scene scene;
  scene.contacts = 1;
  FrameEstimator estimator(optimist, scene, {});
  EquilibriumSolver solver(finger, {});
  ASSERT_TRUE(solver.Solve({{70, 3, 0}}));
  std::mt19937_64 generator(3);
  ErrorTally arc;
  std::vector<double> p_values;
  for (int i = 0; i < 2000; ++i) {
    const FrameEstimate estimate = estimator.Estimate(
        WithNoise(CleanReadings(solver), finger, &generator));
    arc.Add(estimate.contact[0].arc_mm - 70, estimate.contact[0].arc_std_mm, 1);
    p_values.push_back(estimate.p_value());
  }
  EXPECT_LT(arc.share_1(), 0.62);
  EXPECT_GT(KolmogorovSmirnov(p_values), 1.63);
}

}  // namespace
}  // namespace finray
