#include "finray/perception/convex_curve.h"

#include <algorithm>
#include <cmath>

namespace finray {
namespace {

using Eigen::Index;
using Eigen::Vector2d;

double Cell(Index cells) { return 2 * M_PI / static_cast<double>(cells); }

Vector2d Normal(double angle) { return {std::cos(angle), std::sin(angle)}; }

// An angle from 0 up to a turn, the whole turns before it, and its cell.
struct Place {
  Place(double angle, Index cells) {
    turns = std::floor(angle / (2 * M_PI));
    within = angle - turns * 2 * M_PI;
    cell = std::min(static_cast<Index>(within / Cell(cells)), cells - 1);
  }
  double turns, within;
  Index cell;
};

}  // namespace

ConvexCurve::ConvexCurve(const Vector2d& start_mm, const Radii& radii_mm)
    : start_(start_mm), radii_(radii_mm) {}

Vector2d ConvexCurve::At(double normal_angle_rad) const {
  return start_ + SlopeAt(normal_angle_rad, cells()) * radii_;
}

// The integral of t over a cell is the change of n.
ConvexCurve::PointSlope ConvexCurve::SlopeAt(double normal_angle_rad,
                                             Index cells) {
  PointSlope slope = PointSlope::Zero(2, cells);
  const Place place(normal_angle_rad, cells);
  Vector2d before = Normal(0);
  for (Index j = 0; j < place.cell; ++j) {
    const Vector2d after = Normal(Cell(cells) * static_cast<double>(j + 1));
    slope.col(j) = after - before;
    before = after;
  }
  slope.col(place.cell) = Normal(place.within) - before;
  return slope;
}

double ConvexCurve::MeanRadius(double normal_angle_rad,
                               double reach_rad) const {
  return (ArcAt(normal_angle_rad + reach_rad) -
          ArcAt(normal_angle_rad - reach_rad)) /
         (2 * reach_rad);
}

double ConvexCurve::perimeter_mm() const {
  return radii_.sum() * Cell(cells());
}

double ConvexCurve::ArcAt(double normal_angle_rad) const {
  const Place place(normal_angle_rad, cells());
  const double before = Cell(cells()) * static_cast<double>(place.cell);
  return place.turns * perimeter_mm() +
         radii_.head(place.cell).sum() * Cell(cells()) +
         radii_[place.cell] * (place.within - before);
}

double ConvexCurve::NormalAngleAt(double arc_mm) const {
  const double turns = std::floor(arc_mm / perimeter_mm());
  double left = arc_mm - turns * perimeter_mm();
  const double cell = Cell(cells());
  for (Index j = 0; j < cells(); ++j) {
    const double length = radii_[j] * cell;
    if (left <= length || j + 1 == cells()) {
      return turns * 2 * M_PI + cell * static_cast<double>(j) +
             (length > 0 ? left / radii_[j] : 0);
    }
    left -= length;
  }
  return turns * 2 * M_PI;
}

}  // namespace finray
