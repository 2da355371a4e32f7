#include "finray/calib/solve/frame_sum_residual.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <utility>

namespace finray {

FrameSumResidual::FrameSumResidual(const Eigen::VectorXd& start,
                                   const Eigen::MatrixXd& units,
                                   Evaluator evaluator)
    : start_(start), units_(units), evaluator_(std::move(evaluator)) {
  const int n = static_cast<int>(units.cols());
  set_num_residuals(n + 1);
  mutable_parameter_block_sizes()->push_back(n);
}

bool FrameSumResidual::Evaluate(double const* const* parameters,
                                double* residuals, double** jacobians) const {
  using RowMajor =
      Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const Eigen::Index n = units_.cols();
  const Eigen::Map<const Eigen::VectorXd> z(parameters[0], n);
  FrameSums sums;
  if (!evaluator_(start_ + units_ * z, &sums)) return false;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(
      units_.transpose() * sums.information * units_);
  // If the frames do not determine a direction, the gradient along it is
  // rounding.
  const double least = 1e-14 * eigen.eigenvalues()[n - 1];
  const Eigen::VectorXd root = eigen.eigenvalues().cwiseMax(0).cwiseSqrt();
  Eigen::Map<Eigen::VectorXd> r(residuals, n + 1);
  r.head(n) =
      eigen.eigenvectors().transpose() * (units_.transpose() * sums.gradient);
  for (Eigen::Index k = 0; k < n; ++k) {
    r[k] = eigen.eigenvalues()[k] > least ? r[k] / root[k] : 0;
  }
  r[n] = std::sqrt(std::max(0.0, 2 * sums.cost - r.head(n).squaredNorm()));
  if (jacobians != nullptr && jacobians[0] != nullptr) {
    Eigen::Map<RowMajor> jacobian(jacobians[0], n + 1, n);
    jacobian.topRows(n) = root.asDiagonal() * eigen.eigenvectors().transpose();
    jacobian.row(n).setZero();
  }
  return true;
}

}  // namespace finray
