#include "finray/perception/outline_cost.h"

#include <gtest/gtest.h>

#include <cmath>

namespace finray {
namespace {

// Compares the slopes of both blocks with central differences.
void ExpectSlopes(const OutlineCost& cost, std::vector<double> u,
                  Eigen::Vector2d start) {
  const int rows = cost.num_residuals();
  const auto cells = static_cast<int>(u.size());
  std::vector<double> by_u(u.size() * rows), by_start(2 * rows);
  std::vector<double> residual(rows), plus(rows), minus(rows);
  const double* parameters[] = {u.data(), start.data()};
  double* jacobians[] = {by_u.data(), by_start.data()};
  ASSERT_TRUE(cost.Evaluate(parameters, residual.data(), jacobians));
  const auto check = [&](double* value, double slope, int row) {
    const double at = *value, step = 1e-6;
    *value = at + step;
    cost.Evaluate(parameters, plus.data(), nullptr);
    *value = at - step;
    cost.Evaluate(parameters, minus.data(), nullptr);
    *value = at;
    EXPECT_NEAR(slope, (plus[row] - minus[row]) / (2 * step),
                1e-6 * (1 + std::abs(slope)));
  };
  for (int row = 0; row < rows; ++row) {
    for (int j = 0; j < cells; ++j) check(&u[j], by_u[row * cells + j], row);
    for (int k = 0; k < 2; ++k) {
      check(&start[k], by_start[row * 2 + k], row);
    }
  }
}

std::vector<double> SomeLogarithms(Eigen::Index cells) {
  std::vector<double> u;
  for (Eigen::Index j = 0; j < cells; ++j) u.push_back(2 + std::sin(3.0 * j));
  return u;
}

TEST(OutlineCostTest, Slopes) {
  const NormalGrid grid(10, {1.5});
  const std::vector<double> u = SomeLogarithms(grid.cells());
  OutlineCost::Whitening whitening(2, 2);
  whitening << 3, 1, 0, 2;
  ExpectSlopes(*OutlineCost::Point({9, 4}, 2.5, whitening, false, grid), u,
               {1, -2});
  ExpectSlopes(*OutlineCost::Closure(grid, 0.5), u, {1, -2});
}

TEST(OutlineCostTest, OneSidedCountsTheFarSideOnly) {
  const NormalGrid grid(8);
  // A circle of radius 5 about the origin; at the normal 0 it is at (5, 0).
  const std::vector<double> u(8, std::log(5.0));
  const double start[] = {5, 0};
  const double* parameters[] = {u.data(), start};
  OutlineCost::Whitening outward(1, 2);
  outward << 10, 0;
  for (const double x : {4.9, 5.1}) {
    double residual = 0;
    OutlineCost::Point({x, 0}, 0, outward, true, grid)
        ->Evaluate(parameters, &residual, nullptr);
    EXPECT_NEAR(residual, x < 5 ? -1 : 0, 1e-12);
  }
}

// Neighbours are linked across an edge; its own cells are linked apart.
TEST(OutlineCostTest, RoughnessPassesOverEdges) {
  const NormalGrid grid(10, {1.5});
  Eigen::VectorXd u = Eigen::VectorXd::Ones(grid.cells());
  for (Eigen::Index j = 0; j < grid.cells(); ++j) {
    if (grid.IsEdge(j)) u[j] = 6;
  }
  const Eigen::MatrixXd roughness = RoughnessMatrix(grid);
  EXPECT_EQ(roughness.rows(), grid.cells() - 1);
  EXPECT_TRUE((roughness * u).isZero(0));
}

}  // namespace
}  // namespace finray
