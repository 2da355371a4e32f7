#include "finray/perception/outline_cost.h"

#include <cmath>

namespace finray {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Small, because the lengths of an edge's cells together set its direction.
constexpr double kEdgeLink = 0.01;

}  // namespace

OutlineCost::OutlineCost(const VectorXd& offset, const Whitening& by_start,
                         const MatrixXd& by_radii, bool one_sided)
    : offset_(offset),
      by_start_(by_start),
      by_radii_(by_radii),
      one_sided_(one_sided) {
  set_num_residuals(static_cast<int>(offset.size()));
  mutable_parameter_block_sizes()->assign(
      {static_cast<int>(by_radii.cols()), 2});
}

std::unique_ptr<OutlineCost> OutlineCost::Point(const Eigen::Vector2d& point_mm,
                                                double normal_angle_rad,
                                                const Whitening& whitening,
                                                bool one_sided,
                                                const NormalGrid& grid) {
  return std::unique_ptr<OutlineCost>(new OutlineCost(
      whitening * point_mm, whitening,
      whitening * ConvexCurve::SlopeAt(normal_angle_rad, grid), one_sided));
}

std::unique_ptr<OutlineCost> OutlineCost::Closure(const NormalGrid& grid,
                                                  double std_mm) {
  return std::unique_ptr<OutlineCost>(
      new OutlineCost(VectorXd::Zero(2), Whitening::Zero(2, 2),
                      ConvexCurve::ClosureSlope(grid) / std_mm, false));
}

bool OutlineCost::Evaluate(double const* const* parameters, double* residuals,
                           double** jacobians) const {
  using RowsMap = Eigen::Map<
      Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>;
  const Index rows = by_radii_.rows(), cells = by_radii_.cols();
  const VectorXd radii =
      Eigen::Map<const VectorXd>(parameters[0], cells).array().exp();
  Eigen::Map<VectorXd> residual(residuals, rows);
  residual = offset_ -
             by_start_ * Eigen::Map<const Eigen::Vector2d>(parameters[1]) -
             by_radii_ * radii;
  const bool idle = one_sided_ && residual[0] > 0;
  if (idle) residual.setZero();
  if (jacobians == nullptr) return true;
  const double sign = idle ? 0 : -1;
  if (jacobians[0] != nullptr) {
    RowsMap(jacobians[0], rows, cells) = sign * by_radii_ * radii.asDiagonal();
  }
  if (jacobians[1] != nullptr) {
    RowsMap(jacobians[1], rows, 2) = sign * by_start_;
  }
  return residual.allFinite();
}

MatrixXd RoughnessMatrix(const NormalGrid& grid) {
  const Index cells = grid.cells();
  const auto middle = [&](Index cell) {
    return grid.Start(cell) + 0.5 * grid.Width(cell);
  };
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
    double distance = middle(j) - middle(before);
    if (distance <= 0) distance += 2 * M_PI;
    link(before, j, 1 / std::sqrt(distance));
    before = j;
  }
  return rows.topRows(count);
}

}  // namespace finray
