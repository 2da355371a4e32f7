#include "finray/residuals/gauge_reading_residual.h"

#include <cmath>

#include "residuals_fixture.h"

namespace finray {
namespace {

class GaugeReadingResidualTest : public ResidualsFixture {};
INSTANTIATE_TEST_SUITE_P(Forms, GaugeReadingResidualTest,
                         testing::Values(EquilibriumForm::kReduced,
                                         EquilibriumForm::kWeighted),
                         FormName);

TEST_P(GaugeReadingResidualTest, Nominal) {
  double gain = 1.7, offset = 0.2, volts = 0.31;
  std::vector<double*> blocks = Blocks();
  blocks.push_back(&gain);
  blocks.push_back(&offset);
  const std::unique_ptr<ceres::CostFunction> cost(
      new GaugeReadingResidual(frame_, 2, &volts, 0.01));
  double residual;
  ASSERT_TRUE(cost->Evaluate(blocks.data(), &residual, nullptr));
  EXPECT_NEAR(residual, (1.7 * frame_->outputs()[2] + 0.2 - 0.31) / 0.01,
              1e-12);
  volts = std::nan("");
  ASSERT_TRUE(cost->Evaluate(blocks.data(), &residual, nullptr));
  EXPECT_EQ(residual, 0);
}

TEST_P(GaugeReadingResidualTest, AnalyticalVersusFiniteDifferences) {
  double gain = 1.7, offset = 0.2, volts = 0.31;
  std::vector<double*> blocks = Blocks();
  blocks.push_back(&gain);
  blocks.push_back(&offset);
  for (int j = 0; j < 4; ++j) {
    const std::unique_ptr<ceres::CostFunction> cost(
        new GaugeReadingResidual(frame_, j, &volts, 0.01));
    CheckDerivatives(*cost, blocks, 1e-6);
  }
}

// The terms are an offset, a drift rate after 0.4 h and a temperature
// coefficient 7 degrees below the reference.
TEST_P(GaugeReadingResidualTest, TermsBesideTheOffset) {
  double gain = 1.7, volts = 0.31, term[] = {0.2, -0.03, 0.004};
  std::vector<double*> blocks = Blocks();
  blocks.push_back(&gain);
  for (double& x : term) blocks.push_back(&x);
  const std::unique_ptr<ceres::CostFunction> cost(
      new GaugeReadingResidual(frame_, 1, &volts, 0.01, {1, 0.4, -7}));
  double residual;
  ASSERT_TRUE(cost->Evaluate(blocks.data(), &residual, nullptr));
  EXPECT_NEAR(residual,
              (1.7 * frame_->outputs()[1] + 0.2 - 0.012 - 0.028 - 0.31) / 0.01,
              1e-12);
  CheckDerivatives(*cost, blocks, 1e-6);
}

}  // namespace
}  // namespace finray
