#include "finray/residuals/parameter_prior_residual.h"

#include <gtest/gtest.h>

#include <memory>

namespace finray {
namespace {

TEST(ParameterPriorResidualTest, IsTheDistanceInStd) {
  const std::unique_ptr<ceres::CostFunction> cost(
      ParameterPriorResidual::Create(Eigen::Vector2d(1, 10),
                                     Eigen::Vector2d(0.5, 4)));
  const double x[2] = {2, 8};
  const double* blocks[] = {x};
  double residuals[2];
  ASSERT_TRUE(cost->Evaluate(blocks, residuals, nullptr));
  EXPECT_DOUBLE_EQ(residuals[0], 2);
  EXPECT_DOUBLE_EQ(residuals[1], -0.5);
}

}  // namespace
}  // namespace finray
