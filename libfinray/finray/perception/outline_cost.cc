#include "finray/perception/outline_cost.h"

#include <cmath>

namespace finray {
namespace {

using Rows =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using RowsMap = Eigen::Map<Rows>;

// Loose: how an edge's cells share its length is the edge's direction.
constexpr double kEdgeLink = 0.01;

Eigen::VectorXd Radii(const double* u, Eigen::Index cells) {
  return Eigen::Map<const Eigen::VectorXd>(u, cells).array().exp();
}

}  // namespace

OutlinePointCost::OutlinePointCost(const Eigen::Vector2d& point_mm,
                                   double normal_angle_rad,
                                   const Whitening& whitening, bool one_sided,
                                   const NormalGrid& grid)
    : point_(point_mm),
      whitening_(whitening),
      one_sided_(one_sided),
      slope_(ConvexCurve::SlopeAt(normal_angle_rad, grid)) {
  set_num_residuals(static_cast<int>(whitening.rows()));
  mutable_parameter_block_sizes()->assign({static_cast<int>(grid.cells()), 2});
}

bool OutlinePointCost::Evaluate(double const* const* parameters,
                                double* residuals, double** jacobians) const {
  const Eigen::Index cells = slope_.cols(), rows = whitening_.rows();
  const Eigen::VectorXd radii = Radii(parameters[0], cells);
  const Eigen::Vector2d start(parameters[1][0], parameters[1][1]);
  Eigen::Map<Eigen::VectorXd> residual(residuals, rows);
  residual = whitening_ * (point_ - start - slope_ * radii);
  const bool idle = one_sided_ && residual[0] > 0;
  if (idle) residual.setZero();
  if (jacobians == nullptr) return true;
  if (jacobians[0] != nullptr) {
    RowsMap by_u(jacobians[0], rows, cells);
    by_u = idle ? Rows(Rows::Zero(rows, cells))
                : Rows(-whitening_ * slope_ * radii.asDiagonal());
  }
  if (jacobians[1] != nullptr) {
    RowsMap by_start(jacobians[1], rows, 2);
    by_start = idle ? Rows(Rows::Zero(rows, 2)) : Rows(-whitening_);
  }
  return residual.allFinite();
}

OutlineRoughnessCost::OutlineRoughnessCost(const NormalGrid& grid)
    : cells_(grid.cells()) {
  const auto middle = [&](Eigen::Index cell) {
    return grid.Start(cell) + 0.5 * grid.Width(cell);
  };
  const auto link = [&](Eigen::Index from, Eigen::Index to) {
    double distance = middle(to) - middle(from);
    if (distance <= 0) distance += 2 * M_PI;
    links_.push_back({from, to, 1 / std::sqrt(distance)});
  };
  // The last cell is no edge's (normal_grid.cc).
  Eigen::Index before = cells_ - 1;
  for (Eigen::Index j = 0; j < cells_; ++j) {
    if (grid.IsEdge(j)) {
      if (grid.IsEdge(j + 1)) links_.push_back({j, j + 1, kEdgeLink});
      continue;
    }
    link(before, j);
    before = j;
  }
  set_num_residuals(static_cast<int>(links_.size()));
  mutable_parameter_block_sizes()->assign({static_cast<int>(cells_)});
}

bool OutlineRoughnessCost::Evaluate(double const* const* parameters,
                                    double* residuals,
                                    double** jacobians) const {
  const double* u = parameters[0];
  for (std::size_t k = 0; k < links_.size(); ++k) {
    const Link& link = links_[k];
    residuals[k] = link.weight * (u[link.to] - u[link.from]);
  }
  if (jacobians == nullptr || jacobians[0] == nullptr) return true;
  RowsMap by_u(jacobians[0], static_cast<Eigen::Index>(links_.size()), cells_);
  by_u.setZero();
  for (std::size_t k = 0; k < links_.size(); ++k) {
    const auto row = static_cast<Eigen::Index>(k);
    by_u(row, links_[k].to) = links_[k].weight;
    by_u(row, links_[k].from) = -links_[k].weight;
  }
  return true;
}

OutlineClosureCost::OutlineClosureCost(const NormalGrid& grid, double std_mm)
    : slope_(ConvexCurve::ClosureSlope(grid) / std_mm) {
  set_num_residuals(2);
  mutable_parameter_block_sizes()->assign({static_cast<int>(grid.cells())});
}

bool OutlineClosureCost::Evaluate(double const* const* parameters,
                                  double* residuals, double** jacobians) const {
  const Eigen::Index cells = slope_.cols();
  const Eigen::VectorXd radii = Radii(parameters[0], cells);
  Eigen::Map<Eigen::Vector2d> residual(residuals);
  residual = slope_ * radii;
  if (jacobians != nullptr && jacobians[0] != nullptr) {
    RowsMap(jacobians[0], 2, cells) = slope_ * radii.asDiagonal();
  }
  return residual.allFinite();
}

}  // namespace finray
