#include "finray/residuals/cylinder_gauge_residual.h"

#include <gtest/gtest.h>

#include <limits>
#include <memory>

namespace finray {
namespace {

TEST(CylinderGaugeResidualTest, AngleIsLengthOverRadius) {
  const double gain = 0.8, curvature = 0.5, length = 36, offset = 1.5,
               drift = 0.1;
  const double* blocks[] = {&gain, &curvature, &length, &offset, &drift};
  double residual, by[5];
  double* jacobians[] = {&by[0], &by[1], &by[2], &by[3], &by[4]};
  const std::unique_ptr<ceres::CostFunction> bent(
      new CylinderGaugeResidual(90, 1.8, 0.01, {1, -0.5}));
  ASSERT_TRUE(bent->Evaluate(blocks, &residual, jacobians));
  EXPECT_NEAR(residual, (0.8 * (0.4 + 0.08) + 1.5 - 0.05 - 1.8) / 0.01, 1e-12);
  EXPECT_NEAR(by[0], 0.48 / 0.01, 1e-12);
  EXPECT_NEAR(by[1], 0.8 * 0.16 / 0.01, 1e-12);
  EXPECT_NEAR(by[2], 0.8 * (1 + 0.4) / 90 / 0.01, 1e-12);
  EXPECT_NEAR(by[3], 1 / 0.01, 1e-12);
  EXPECT_NEAR(by[4], -0.5 / 0.01, 1e-12);
  const std::unique_ptr<ceres::CostFunction> flat(new CylinderGaugeResidual(
      std::numeric_limits<double>::infinity(), 1.8, 0.01));
  ASSERT_TRUE(flat->Evaluate(blocks, &residual, nullptr));
  EXPECT_NEAR(residual, (1.5 - 1.8) / 0.01, 1e-12);
}

}  // namespace
}  // namespace finray
