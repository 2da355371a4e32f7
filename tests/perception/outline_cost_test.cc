#include "finray/perception/outline_cost.h"

#include <gtest/gtest.h>

#include <cmath>

namespace finray {
namespace {

// Compares the slopes by u and start with central differences.
void ExpectSlopes(const OutlineCost& cost, std::vector<double> x) {
  const int rows = cost.num_residuals();
  const std::size_t columns = x.size();
  std::vector<double> by_x(columns * rows), residual(rows), plus(rows),
      minus(rows);
  const double* parameters[] = {x.data()};
  double* jacobians[] = {by_x.data()};
  ASSERT_TRUE(cost.Evaluate(parameters, residual.data(), jacobians));
  for (std::size_t j = 0; j < columns; ++j) {
    const double at = x[j], step = 1e-6;
    x[j] = at + step;
    cost.Evaluate(parameters, plus.data(), nullptr);
    x[j] = at - step;
    cost.Evaluate(parameters, minus.data(), nullptr);
    x[j] = at;
    for (int row = 0; row < rows; ++row) {
      const double slope = by_x[row * columns + j];
      EXPECT_NEAR(slope, (plus[row] - minus[row]) / (2 * step),
                  1e-6 * (1 + std::abs(slope)));
    }
  }
}

// Some logarithms of radii and the start (1, -2).
std::vector<double> SomeOutline(Eigen::Index cells) {
  std::vector<double> x;
  for (Eigen::Index j = 0; j < cells; ++j) x.push_back(2 + std::sin(3.0 * j));
  x.insert(x.end(), {1, -2});
  return x;
}

TEST(OutlineCostTest, Slopes) {
  const NormalGrid grid(10, {1.5});
  const std::vector<double> x = SomeOutline(grid.cells());
  OutlineCost::Whitening whitening(2, 2);
  whitening << 3, 1, 0, 2;
  ExpectSlopes(OutlineCost({9, 4}, 2.5, whitening, false, grid), x);
  ExpectSlopes(OutlineCost(grid, 0.5), x);
}

TEST(OutlineCostTest, OneSidedCountsTheFarSideOnly) {
  const NormalGrid grid(8);
  // A circle of radius 5 about the origin; at the normal 0 it is at (5, 0).
  std::vector<double> outline(8, std::log(5.0));
  outline.insert(outline.end(), {5, 0});
  const double* parameters[] = {outline.data()};
  OutlineCost::Whitening outward(1, 2);
  outward << 10, 0;
  for (const double x : {4.9, 5.1}) {
    double residual = 0;
    OutlineCost({x, 0}, 0, outward, true, grid)
        .Evaluate(parameters, &residual, nullptr);
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
