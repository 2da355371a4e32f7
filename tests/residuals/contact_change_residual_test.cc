#include "finray/residuals/contact_change_residual.h"

#include <gtest/gtest.h>

#include <memory>

namespace finray {
namespace {

TEST(ContactChangeResidualTest, Nominal) {
  const std::unique_ptr<ceres::CostFunction> cost(
      new ContactChangeResidual(0.5, 0.2));
  const double before[] = {70, 2}, after[] = {71, 1.9};
  const double* blocks[] = {before, after};
  double residuals[2], by_before[4], by_after[4];
  double* jacobians[] = {by_before, by_after};
  ASSERT_TRUE(cost->Evaluate(blocks, residuals, jacobians));
  EXPECT_NEAR(residuals[0], 2, 1e-12);
  EXPECT_NEAR(residuals[1], -0.5, 1e-12);
  const double expected[] = {2, 0, 0, 5};
  for (int i = 0; i < 4; ++i) {
    EXPECT_NEAR(by_after[i], expected[i], 1e-12);
    EXPECT_NEAR(by_before[i], -expected[i], 1e-12);
  }
  double* one_block[] = {by_before, nullptr};
  ASSERT_TRUE(cost->Evaluate(blocks, residuals, one_block));
  ASSERT_TRUE(cost->Evaluate(blocks, residuals, nullptr));
}

}  // namespace
}  // namespace finray
