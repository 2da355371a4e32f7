#include "finray/perception/convex_curve.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace finray {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;

// Small, because the lengths of an edge's cells together set its direction.
constexpr double kEdgeLink = 0.01;

Vector2d Normal(double angle) { return {std::cos(angle), std::sin(angle)}; }

// Splits an angle into whole turns from the origin and an angle within the
// first turn.
struct Wrapped {
  Wrapped(double angle, const NormalGrid& grid)
      : turns(std::floor((angle - grid.origin_rad()) / (2 * M_PI))),
        within(angle - turns * 2 * M_PI) {}
  double turns, within;
};

}  // namespace

AngleGap WidestGap(std::vector<double> angles_rad) {
  if (angles_rad.empty()) return {-M_PI, M_PI};
  for (double& angle : angles_rad) {
    angle -= std::floor(angle / (2 * M_PI)) * 2 * M_PI;
  }
  std::sort(angles_rad.begin(), angles_rad.end());
  angles_rad.push_back(angles_rad[0] + 2 * M_PI);
  AngleGap widest{0, 0};
  for (std::size_t i = 0; i + 1 < angles_rad.size(); ++i) {
    if (angles_rad[i + 1] - angles_rad[i] > widest.to_rad - widest.from_rad) {
      widest = {angles_rad[i], angles_rad[i + 1]};
    }
  }
  return widest;
}

// The bounds of the edge cells come first. Bounds of equal cells that are too
// close to them are left out.
NormalGrid::NormalGrid(int cells, const std::vector<double>& edge_angles_rad) {
  const AngleGap gap = WidestGap(edge_angles_rad);
  const double origin = std::fmod(0.5 * (gap.from_rad + gap.to_rad), 2 * M_PI);
  const double half = 0.5 * kEdgeCells * kEdgeCell_rad;
  std::vector<std::pair<double, bool>> starts;  // of cells; edge?
  for (const double angle : edge_angles_rad) {
    const double turns = std::floor((angle - origin) / (2 * M_PI));
    for (int k = 0; k <= kEdgeCells; ++k) {
      starts.emplace_back(angle - turns * 2 * M_PI - half + k * kEdgeCell_rad,
                          k < kEdgeCells);
    }
  }
  for (int j = 0; j < cells; ++j) {
    const double start = origin + 2 * M_PI * j / cells;
    const bool clear = std::none_of(
        edge_angles_rad.begin(), edge_angles_rad.end(), [&](double angle) {
          return std::abs(std::remainder(start - angle, 2 * M_PI)) <
                 half + kEdgeCell_rad / 2;
        });
    if (clear) starts.emplace_back(start, false);
  }
  std::sort(starts.begin(), starts.end());
  bounds_.resize(static_cast<Eigen::Index>(starts.size()) + 1);
  for (std::size_t i = 0; i < starts.size(); ++i) {
    bounds_[static_cast<Eigen::Index>(i)] = starts[i].first;
    edge_.push_back(starts[i].second);
  }
  bounds_[bounds_.size() - 1] = origin + 2 * M_PI;
}

Eigen::Index NormalGrid::CellOf(double angle_rad) const {
  const double* end = bounds_.data() + cells();
  const double* after = std::upper_bound(bounds_.data(), end, angle_rad);
  return std::max<Eigen::Index>(after - bounds_.data() - 1, 0);
}

ConvexCurve::ConvexCurve(const NormalGrid& grid, const Vector2d& start_mm,
                         const Radii& radii_mm)
    : grid_(grid),
      start_(start_mm),
      radii_(radii_mm),
      arcs_(VectorXd::Zero(grid.cells() + 1)) {
  for (Index j = 0; j < grid_.cells(); ++j) {
    arcs_[j + 1] = arcs_[j] + radii_[j] * grid_.Width(j);
  }
}

Vector2d ConvexCurve::At(double normal_angle_rad) const {
  return start_ + SlopeAt(normal_angle_rad, grid_) * radii_;
}

// The integral of t over a cell is the change of n.
ConvexCurve::PointSlope ConvexCurve::SlopeAt(double normal_angle_rad,
                                             const NormalGrid& grid) {
  PointSlope slope = PointSlope::Zero(2, grid.cells());
  const double within = Wrapped(normal_angle_rad, grid).within;
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

double ConvexCurve::RadiusAt(double normal_angle_rad) const {
  return radii_[grid_.CellOf(Wrapped(normal_angle_rad, grid_).within)];
}

double ConvexCurve::MeanRadius(double normal_angle_rad,
                               double reach_rad) const {
  return (ArcAt(normal_angle_rad + reach_rad) -
          ArcAt(normal_angle_rad - reach_rad)) /
         (2 * reach_rad);
}

double ConvexCurve::ArcAt(double normal_angle_rad) const {
  const Wrapped turned(normal_angle_rad, grid_);
  const Index cell = grid_.CellOf(turned.within);
  return turned.turns * perimeter_mm() + arcs_[cell] +
         radii_[cell] * (turned.within - grid_.Start(cell));
}

double ConvexCurve::NormalAngleAt(double arc_mm) const {
  const double turns = std::floor(arc_mm / perimeter_mm());
  const double left = arc_mm - turns * perimeter_mm();
  const double* end = arcs_.data() + grid_.cells();
  const Index cell =
      std::lower_bound(arcs_.data() + 1, end, left) - arcs_.data() - 1;
  return turns * 2 * M_PI + grid_.Start(cell) +
         (left - arcs_[cell]) / radii_[cell];
}

OutlineCost::OutlineCost(const Vector2d& point_mm, double normal_angle_rad,
                         const Whitening& whitening, bool one_sided,
                         const NormalGrid& grid)
    : offset_(whitening * point_mm),
      rows_(whitening.rows(), grid.cells() + 2),
      one_sided_(one_sided) {
  rows_ << whitening * ConvexCurve::SlopeAt(normal_angle_rad, grid), whitening;
  set_num_residuals(static_cast<int>(rows_.rows()));
  mutable_parameter_block_sizes()->assign({static_cast<int>(rows_.cols())});
}

OutlineCost::OutlineCost(const NormalGrid& grid, double std_mm)
    : OutlineCost({0, 0}, std::nextafter(grid.origin_rad() + 2 * M_PI, 0),
                  Eigen::Matrix2d::Identity() / std_mm, false, grid) {
  rows_.rightCols<2>().setZero();
}

bool OutlineCost::Evaluate(double const* const* parameters, double* residuals,
                           double** jacobians) const {
  const Index cells = rows_.cols() - 2;
  VectorXd factors = Eigen::Map<const VectorXd>(parameters[0], cells + 2);
  factors.head(cells) = factors.head(cells).array().exp();
  Eigen::Map<VectorXd> residual(residuals, rows_.rows());
  residual = offset_ - rows_ * factors;
  const bool idle = one_sided_ && residual[0] > 0;
  if (idle) residual.setZero();
  if (jacobians != nullptr && jacobians[0] != nullptr) {
    factors.tail<2>().setOnes();
    Eigen::Map<
        Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(
        jacobians[0], rows_.rows(), rows_.cols()) =
        (idle ? 0 : -1) * rows_ * factors.asDiagonal();
  }
  return residual.allFinite();
}

MatrixXd RoughnessMatrix(const NormalGrid& grid) {
  const Index cells = grid.cells();
  MatrixXd rows = MatrixXd::Zero(cells, cells);
  Index count = 0;
  const auto link = [&](Index from, Index to, double weight) {
    rows(count, from) = -weight;
    rows(count++, to) = weight;
  };
  // The last cell belongs to no edge: the origin is far from all edges.
  Index before = cells - 1;
  for (Index j = 0; j < cells; ++j) {
    if (grid.IsEdge(j)) {
      if (grid.IsEdge(j + 1)) link(j, j + 1, kEdgeLink);
      continue;
    }
    double distance = grid.Middle(j) - grid.Middle(before);
    if (distance <= 0) distance += 2 * M_PI;
    link(before, j, 1 / std::sqrt(distance));
    before = j;
  }
  return rows.topRows(count);
}

}  // namespace finray
