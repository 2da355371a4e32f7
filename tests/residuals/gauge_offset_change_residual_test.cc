#include "finray/residuals/gauge_offset_change_residual.h"

#include <gtest/gtest.h>

#include <memory>

namespace finray {
namespace {

TEST(GaugeOffsetChangeResidualTest, Nominal) {
  const std::unique_ptr<ceres::CostFunction> cost(
      new GaugeOffsetChangeResidual(0.001, 4));
  const double before = 0.010, after = 0.013;
  const double* blocks[] = {&before, &after};
  double residual, by_before, by_after;
  double* jacobians[] = {&by_before, &by_after};
  ASSERT_TRUE(cost->Evaluate(blocks, &residual, jacobians));
  // 3 mV in 4 s, where the walk has a std of 2 mV.
  EXPECT_NEAR(residual, 1.5, 1e-12);
  EXPECT_NEAR(by_before, -500, 1e-9);
  EXPECT_NEAR(by_after, 500, 1e-9);
}

TEST(GaugeOffsetChangeResidualTest, LeavesOutWhatIsNotAskedFor) {
  const std::unique_ptr<ceres::CostFunction> cost(
      new GaugeOffsetChangeResidual(0.001, 1));
  const double before = 0, after = 0;
  const double* blocks[] = {&before, &after};
  double residual, by_after;
  double* jacobians[] = {nullptr, &by_after};
  ASSERT_TRUE(cost->Evaluate(blocks, &residual, jacobians));
  EXPECT_NEAR(by_after, 1000, 1e-9);
  ASSERT_TRUE(cost->Evaluate(blocks, &residual, nullptr));
}

}  // namespace
}  // namespace finray
