#include "finray/perception/convex_curve.h"

#include <gtest/gtest.h>

#include <cmath>

#include "finray/objects/outline.h"

namespace finray {
namespace {

ConvexCurve CurveOf(const Outline& outline, const NormalGrid& grid) {
  Eigen::VectorXd radii(grid.cells());
  for (Eigen::Index j = 0; j < grid.cells(); ++j) {
    radii[j] =
        outline.PointAt(grid.Start(j) + grid.Width(j) / 2).curvature_radius_mm;
  }
  return {grid, outline.PointAt(grid.origin_rad()).position_mm, radii};
}

TEST(ConvexCurveTest, CircleIsExact) {
  const Outline circle(CircleOutline{7});
  for (const NormalGrid& grid : {NormalGrid(9), NormalGrid(30, {1.0, 4.0})}) {
    const ConvexCurve curve = CurveOf(circle, grid);
    for (double a = -7; a < 7; a += 0.31) {
      EXPECT_LT((curve.At(a) - circle.PointAt(a).position_mm).norm(), 1e-13);
    }
    EXPECT_NEAR(curve.perimeter_mm(), 14 * M_PI, 1e-12);
  }
}

// With radii from the middle of each cell the error is of second order in its
// width.
TEST(ConvexCurveTest, EllipseConvergesWithTheCells) {
  const Outline ellipse(EllipseOutline{12, 5});
  double before = 0;
  for (const int cells : {90, 180, 360}) {
    const ConvexCurve curve = CurveOf(ellipse, NormalGrid(cells));
    double worst = 0;
    for (double a = 0; a < 6.2; a += 0.1) {
      worst = std::max(worst,
                       (curve.At(a) - ellipse.PointAt(a).position_mm).norm());
    }
    if (before > 0) {
      EXPECT_NEAR(before / worst, 4, 1.2) << cells;
    }
    before = worst;
  }
  EXPECT_LT(before, 2e-3);
}

TEST(ConvexCurveTest, ArcLengthAndItsInverse) {
  const ConvexCurve curve =
      CurveOf(Outline(EllipseOutline{12, 5}), NormalGrid(60, {0.7}));
  for (double a = -5; a < 10; a += 0.37) {
    EXPECT_NEAR(curve.NormalAngleAt(curve.ArcAt(a)), a, 1e-12);
    const double ahead = curve.ArcAt(a + 1e-6) - curve.ArcAt(a - 1e-6);
    EXPECT_NEAR((curve.At(a + 1e-6) - curve.At(a - 1e-6)).norm(), ahead, 1e-10);
  }
}

TEST(ConvexCurveTest, SlopesAreThoseByTheRadii) {
  const NormalGrid grid(12, {2.0});
  ConvexCurve::Radii radii = ConvexCurve::Radii::LinSpaced(grid.cells(), 1, 9);
  const ConvexCurve curve(grid, {1, 2}, radii);
  for (const double a : {0.1, 1.9, 2.0, 5.0}) {
    const ConvexCurve::PointSlope slope = ConvexCurve::SlopeAt(a, grid);
    for (Eigen::Index j = 0; j < grid.cells(); ++j) {
      ConvexCurve::Radii moved = radii;
      moved[j] += 1;  // linear
      EXPECT_LT(
          (ConvexCurve(grid, {1, 2}, moved).At(a) - curve.At(a) - slope.col(j))
              .norm(),
          1e-13);
    }
  }
}

TEST(NormalGridTest, EdgesHaveNarrowCellsAwayFromTheOrigin) {
  const NormalGrid grid(36, {0.0, M_PI / 2});
  EXPECT_NEAR(std::remainder(grid.origin_rad() - 1.25 * M_PI, 2 * M_PI), 0,
              1e-12);
  int edge = 0;
  double around = 0;
  for (Eigen::Index j = 0; j < grid.cells(); ++j) {
    around += grid.Width(j);
    ASSERT_GT(grid.Width(j), 0);
    if (!grid.IsEdge(j)) continue;
    ++edge;
    EXPECT_NEAR(grid.Width(j), NormalGrid::kEdgeCell_rad, 1e-12);
  }
  EXPECT_EQ(edge, 2 * NormalGrid::kEdgeCells);
  EXPECT_NEAR(around, 2 * M_PI, 1e-12);
}

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
