#include "finray/residuals/gauge_reading_residual.h"

#include <cmath>

#include "finray/finger/gauge_lag.h"
#include "residuals_fixture.h"

namespace finray {
namespace {

class GaugeReadingResidualTest : public ResidualsFixture {
 protected:
  static Measurements Reading(double volts) {
    Measurements row;
    row.gauges_V.assign(4, volts);
    return row;
  }
};
INSTANTIATE_TEST_SUITE_P(Forms, GaugeReadingResidualTest,
                         testing::Values(EquilibriumForm::kReduced,
                                         EquilibriumForm::kWeighted),
                         FormName);

TEST_P(GaugeReadingResidualTest, Nominal) {
  double gain = 1.7, curvature = 0.6, offset = 0.2;
  Measurements row = Reading(0.31);
  std::vector<double*> blocks = Blocks();
  blocks.insert(blocks.end(), {&gain, &curvature, &offset});
  const std::unique_ptr<ceres::CostFunction> cost(
      new GaugeReadingResidual(frame_, 2, &row, 0.01));
  double residual;
  ASSERT_TRUE(cost->Evaluate(blocks.data(), &residual, nullptr));
  const double angle = frame_->outputs()[2];
  EXPECT_NEAR(residual,
              (1.7 * (angle + 0.6 * angle * angle) + 0.2 - 0.31) / 0.01, 1e-12);
  row.gauges_V[2] = std::nan("");
  ASSERT_TRUE(cost->Evaluate(blocks.data(), &residual, nullptr));
  EXPECT_EQ(residual, 0);
}

TEST_P(GaugeReadingResidualTest, AnalyticalVersusFiniteDifferences) {
  double gain = 1.7, curvature = 0.6, offset = 0.2;
  Measurements row = Reading(0.31);
  std::vector<double*> blocks = Blocks();
  blocks.insert(blocks.end(), {&gain, &curvature, &offset});
  for (int j = 0; j < 4; ++j) {
    const std::unique_ptr<ceres::CostFunction> cost(
        new GaugeReadingResidual(frame_, j, &row, 0.01));
    CheckDerivatives(*cost, blocks, 1e-6);
  }
}

// The terms are an offset, a drift rate after 0.4 h and a temperature
// coefficient 7 degrees below the reference.
TEST_P(GaugeReadingResidualTest, TermsBesideTheOffset) {
  double gain = 1.7, curvature = 0, term[] = {0.2, -0.03, 0.004};
  Measurements row = Reading(0.31);
  std::vector<double*> blocks = Blocks();
  blocks.push_back(&gain);
  blocks.push_back(&curvature);
  for (double& x : term) blocks.push_back(&x);
  const std::unique_ptr<ceres::CostFunction> cost(
      new GaugeReadingResidual(frame_, 1, &row, 0.01, {1, 0.4, -7}));
  double residual;
  ASSERT_TRUE(cost->Evaluate(blocks.data(), &residual, nullptr));
  EXPECT_NEAR(residual,
              (1.7 * frame_->outputs()[1] + 0.2 - 0.012 - 0.028 - 0.31) / 0.01,
              1e-12);
  CheckDerivatives(*cost, blocks, 1e-6);
}

// The reading is that of a gauge which has crept for a while.
TEST_P(GaugeReadingResidualTest, Creep) {
  ReadingHistory history;
  history.Set(0, 10, 0.25, 2);
  history.Set(2, 30, 0.5, 2);
  history.Set(3, 37, 0.31, 2);
  double gain = 1.7, curvature = 0.6, offset = 0.2;
  double share = 0.2, ln_time = std::log(12), drift = 0.01, hysteresis = 0;
  Measurements row = Reading(0.31);
  std::vector<double*> blocks = Blocks();
  blocks.insert(blocks.end(), {&gain, &curvature, &share, &ln_time, &hysteresis,
                               &offset, &drift});
  const std::unique_ptr<ceres::CostFunction> cost(
      new GaugeReadingResidual(frame_, 1, &row, 0.01, {1, 0.4},
                               {&history, 3, &share, &ln_time, &hysteresis}));
  // The slope by the hysteresis bends at 0.
  CheckDerivatives(*cost, blocks, 3e-5);
  GaugeLag<double> lag(share, 12);
  lag.Next(10, 0.25 - offset);
  lag.Next(30, 0.5 - offset);
  const double z = lag.Next(37, 0.31 - offset);
  Gauge gauge;
  gauge.gain_V_per_rad = gain;
  gauge.curvature_per_rad = curvature;
  double residual;
  ASSERT_TRUE(cost->Evaluate(blocks.data(), &residual, nullptr));
  EXPECT_NEAR(residual,
              (gauge.BendingVolts(frame_->outputs()[1]) + offset + 0.004 -
               (0.31 - share * z)) /
                  0.01,
              1e-9);
  share = -1;
  EXPECT_FALSE(cost->Evaluate(blocks.data(), &residual, nullptr));
}

// The reading is that of a gauge with hysteresis that has just fallen, and one
// that creeps as well.
TEST_P(GaugeReadingResidualTest, Hysteresis) {
  ReadingHistory history;
  history.set_noise_V(1e-3);
  history.Set(0, 10, 0.25, 1e4);
  history.Set(1, 30, 0.5, 1e4);
  history.Set(2, 37, 0.31, 1e4);
  history.Set(3, 40, 0.309, 1e4);  // hardly
  double gain = -1.7, curvature = 0.6, offset = 0.2;
  double share = 0, ln_time = std::log(12), hysteresis = 4e-3;
  Measurements row = Reading(0.31);
  std::vector<double*> blocks = Blocks();
  blocks.insert(blocks.end(),
                {&gain, &curvature, &share, &ln_time, &hysteresis, &offset});
  for (const int at : {2, 3}) {
    const std::unique_ptr<ceres::CostFunction> cost(new GaugeReadingResidual(
        frame_, 1, &row, 0.01, {1},
        {&history, at, &share, &ln_time, &hysteresis}));
    share = 0.1;
    CheckDerivatives(*cost, blocks, 1e-5);
    share = 0;
    CheckDerivatives(*cost, blocks, 1e-5);
    if (at == 3) continue;
    Gauge gauge;
    gauge.gain_V_per_rad = gain;
    gauge.curvature_per_rad = curvature;
    double residual;
    ASSERT_TRUE(cost->Evaluate(blocks.data(), &residual, nullptr));
    EXPECT_NEAR(residual,
                (gauge.BendingVolts(frame_->outputs()[1]) + offset -
                 (0.31 - 1.7 * 4e-3)) /
                    0.01,
                1e-6);
  }
  // Where it has hardly moved, it may be anywhere in the loop.
  EXPECT_EQ(history.KeptStd_V(3), 0);
  history.KeepStd({0, ln_time, 1.7 * 4e-3});
  EXPECT_LT(history.KeptStd_V(2), 1e-5);
  EXPECT_NEAR(history.KeptStd_V(3), 1.7 * 4e-3 / std::sqrt(3.0), 1e-3);
}

TEST_P(GaugeReadingResidualTest, LessSensitiveWhenFlat) {
  double gain = 1.7, curvature = 0.6, offset = 0.2;
  double share = 0.3, ln_width = std::log(0.02);
  Measurements row = Reading(0.31);
  std::vector<double*> blocks = Blocks();
  blocks.insert(blocks.end(), {&gain, &curvature, &share, &ln_width, &offset});
  const std::unique_ptr<ceres::CostFunction> cost(
      new GaugeReadingResidual(frame_, 1, &row, 0.01, {1}, {}, true));
  CheckDerivatives(*cost, blocks, 1e-6);
  const double a = frame_->outputs()[1];
  double residual;
  ASSERT_TRUE(cost->Evaluate(blocks.data(), &residual, nullptr));
  const double signal = a * (1 + 0.6 * a) - 0.3 * a / std::hypot(1, a / 0.02);
  EXPECT_NEAR(residual, (1.7 * signal + 0.2 - 0.31) / 0.01, 1e-10);
}

// A gauge that is moved reads the same as one that has always been there.
TEST_P(GaugeReadingResidualTest, MovedGauges) {
  shared_.gauge_starts_mm[1] += 1.5;
  shared_.gauge_lengths_mm[1] -= 0.7;
  FrameEvaluation& moved =
      frames_->Add(1, kFriction, unknowns_.data(), true, true);
  frames_->PrepareForEvaluation(true, true);
  double gain = 1.7, curvature = 0.6, offset = 0.2;
  Measurements row = Reading(0.31);
  std::vector<double*> blocks = Blocks();
  blocks.insert(blocks.end(), {&gain, &curvature, &shared_.gauge_starts_mm[1],
                               &shared_.gauge_lengths_mm[1], &offset});
  const std::unique_ptr<ceres::CostFunction> cost(
      new GaugeReadingResidual(&moved, 1, &row, 0.01));
  CheckDerivatives(*cost, blocks, 1e-6);
  if (GetParam() == EquilibriumForm::kReduced) {
    Finger there = finger_;
    there.gauges[1].start_mm = shared_.gauge_starts_mm[1];
    there.gauges[1].length_mm = shared_.gauge_lengths_mm[1];
    EquilibriumSolver solver(there, {});
    ASSERT_TRUE(solver.Solve({{67, 4, kFriction}}));
    for (int j = 0; j < 4; ++j) {
      EXPECT_NEAR(moved.outputs()[j], solver.gauge_angle(j), 1e-9);
    }
  }
  shared_.gauge_starts_mm[1] = -1;
  frames_->PrepareForEvaluation(true, true);
  EXPECT_FALSE(moved.valid());
}

}  // namespace
}  // namespace finray
