#include "finray/perception/outline_cost.h"

#include <cmath>

namespace finray {
namespace {

using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic,
                           Eigen::RowMajor>;
using RowsMap = Eigen::Map<Rows>;

Eigen::VectorXd Radii(const double* u, Eigen::Index cells) {
  return Eigen::Map<const Eigen::VectorXd>(u, cells).array().exp();
}

}  // namespace

OutlinePointCost::OutlinePointCost(const Eigen::Vector2d& point_mm,
                                   double normal_angle_rad,
                                   const Whitening& whitening, bool one_sided,
                                   Eigen::Index cells)
    : point_(point_mm),
      whitening_(whitening),
      one_sided_(one_sided),
      slope_(ConvexCurve::SlopeAt(normal_angle_rad, cells)) {
  set_num_residuals(static_cast<int>(whitening.rows()));
  mutable_parameter_block_sizes()->assign({static_cast<int>(cells), 2});
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

OutlineRoughnessCost::OutlineRoughnessCost(Eigen::Index cells)
    : weight_(std::sqrt(static_cast<double>(cells) / (2 * M_PI))) {
  set_num_residuals(static_cast<int>(cells));
  mutable_parameter_block_sizes()->assign({static_cast<int>(cells)});
}

bool OutlineRoughnessCost::Evaluate(double const* const* parameters,
                                    double* residuals,
                                    double** jacobians) const {
  const int cells = num_residuals();
  const double* u = parameters[0];
  for (int j = 0; j < cells; ++j) {
    residuals[j] = weight_ * (u[(j + 1) % cells] - u[j]);
  }
  if (jacobians == nullptr || jacobians[0] == nullptr) return true;
  RowsMap by_u(jacobians[0], cells, cells);
  by_u.setZero();
  for (int j = 0; j < cells; ++j) {
    by_u(j, (j + 1) % cells) = weight_;
    by_u(j, j) = -weight_;
  }
  return true;
}

OutlineClosureCost::OutlineClosureCost(Eigen::Index cells, double std_mm)
    : slope_(ConvexCurve::SlopeAt(std::nextafter(2 * M_PI, 0), cells) /
             std_mm) {
  set_num_residuals(2);
  mutable_parameter_block_sizes()->assign({static_cast<int>(cells)});
}

bool OutlineClosureCost::Evaluate(double const* const* parameters,
                                  double* residuals,
                                  double** jacobians) const {
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
