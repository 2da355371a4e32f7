#include "finray/residuals/gaussian_prior_residual.h"

#include <gtest/gtest.h>

#include <memory>

namespace finray {
namespace {

// Blocks of sizes 1 and 2.
TEST(GaussianPriorResidualTest, SquaresAddUpToTheMahalanobisDistance) {
  Eigen::Matrix3d information;
  information << 4, 1, -0.5, 1, 3, 0.7, -0.5, 0.7, 2;
  const Eigen::Vector3d mean(1, -2, 0.5);
  const std::unique_ptr<ceres::CostFunction> cost(
      new GaussianPriorResidual(mean, information, {1, 2}));
  const double first = 1.3, second[] = {-2.5, 0.1};
  const double* blocks[] = {&first, second};
  Eigen::Vector3d r, by_first;
  Eigen::Matrix<double, 3, 2, Eigen::RowMajor> by_second;
  double* jacobians[] = {by_first.data(), by_second.data()};
  ASSERT_TRUE(cost->Evaluate(blocks, r.data(), jacobians));
  const Eigen::Vector3d off(0.3, -0.5, -0.4);
  EXPECT_NEAR(r.squaredNorm(), off.dot(information * off), 1e-12);
  Eigen::Matrix3d jacobian;
  jacobian << by_first, by_second;
  EXPECT_LT((jacobian.transpose() * jacobian - information).norm(), 1e-12);
  EXPECT_LT((jacobian * off - r).norm(), 1e-12);
  ASSERT_TRUE(cost->Evaluate(blocks, r.data(), nullptr));
}

TEST(GaussianPriorResidualTest, SingularInformationSaysNothingOfTheRest) {
  Eigen::Matrix2d information;
  information << 1, 1, 1, 1;
  const std::unique_ptr<ceres::CostFunction> cost(
      new GaussianPriorResidual(Eigen::Vector2d::Zero(), information, {1, 1}));
  const double x = 5, y = -5;
  const double* blocks[] = {&x, &y};
  Eigen::Vector2d r;
  ASSERT_TRUE(cost->Evaluate(blocks, r.data(), nullptr));
  EXPECT_NEAR(r.norm(), 0, 1e-6);
}

}  // namespace
}  // namespace finray
