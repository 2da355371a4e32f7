#include "finray/perception/convex_curve.h"

#include <cmath>

namespace finray {
namespace {

using Eigen::Index;
using Eigen::Vector2d;

Vector2d Normal(double angle) { return {std::cos(angle), std::sin(angle)}; }

// An angle as whole turns from the origin and the angle within the first one.
struct Turned {
  Turned(double angle, const NormalGrid& grid)
      : turns(std::floor((angle - grid.origin_rad()) / (2 * M_PI))),
        within(angle - turns * 2 * M_PI) {}
  double turns, within;
};

}  // namespace

ConvexCurve::ConvexCurve(const NormalGrid& grid, const Vector2d& start_mm,
                         const Radii& radii_mm)
    : grid_(grid), start_(start_mm), radii_(radii_mm) {}

Vector2d ConvexCurve::At(double normal_angle_rad) const {
  return start_ + SlopeAt(normal_angle_rad, grid_) * radii_;
}

// The integral of t over a cell is the change of n.
ConvexCurve::PointSlope ConvexCurve::SlopeAt(double normal_angle_rad,
                                             const NormalGrid& grid) {
  PointSlope slope = PointSlope::Zero(2, grid.cells());
  const double within = Turned(normal_angle_rad, grid).within;
  const Index last = grid.CellOf(within);
  Vector2d before = Normal(grid.origin_rad());
  for (Index j = 0; j < last; ++j) {
    const Vector2d after = Normal(grid.Start(j + 1));
    slope.col(j) = after - before;
    before = after;
  }
  slope.col(last) = Normal(within) - before;
  return slope;
}

ConvexCurve::PointSlope ConvexCurve::ClosureSlope(const NormalGrid& grid) {
  return SlopeAt(std::nextafter(grid.origin_rad() + 2 * M_PI, 0), grid);
}

double ConvexCurve::MeanRadius(double normal_angle_rad,
                               double reach_rad) const {
  return (ArcAt(normal_angle_rad + reach_rad) -
          ArcAt(normal_angle_rad - reach_rad)) /
         (2 * reach_rad);
}

double ConvexCurve::perimeter_mm() const {
  double perimeter = 0;
  for (Index j = 0; j < grid_.cells(); ++j) {
    perimeter += radii_[j] * grid_.Width(j);
  }
  return perimeter;
}

double ConvexCurve::ArcAt(double normal_angle_rad) const {
  const Turned turned(normal_angle_rad, grid_);
  const Index cell = grid_.CellOf(turned.within);
  double arc = turned.turns * perimeter_mm();
  for (Index j = 0; j < cell; ++j) arc += radii_[j] * grid_.Width(j);
  return arc + radii_[cell] * (turned.within - grid_.Start(cell));
}

double ConvexCurve::NormalAngleAt(double arc_mm) const {
  const double perimeter = perimeter_mm();
  const double turns = std::floor(arc_mm / perimeter);
  double left = arc_mm - turns * perimeter;
  Index cell = 0;
  for (; cell + 1 < grid_.cells(); ++cell) {
    const double length = radii_[cell] * grid_.Width(cell);
    if (left <= length) break;
    left -= length;
  }
  return turns * 2 * M_PI + grid_.Start(cell) + left / radii_[cell];
}

}  // namespace finray
