#include "finray/calib/solve/frame_sum_residual.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <utility>

namespace finray {

FrameSumResidual::FrameSumResidual(const Eigen::VectorXd& start,
                                   const Eigen::MatrixXd& units,
                                   const FrameSums& at_start,
                                   Evaluator evaluator)
    : start_(start),
      units_(units),
      evaluator_(std::move(evaluator)),
      at_(Eigen::VectorXd::Zero(units.cols())),
      valid_(true) {
  const int n = static_cast<int>(units.cols());
  set_num_residuals(n + 1);
  mutable_parameter_block_sizes()->push_back(n);
  Compress(at_start);
}

bool FrameSumResidual::EvaluateAt(const Eigen::VectorXd& z) const {
  if (at_ == z) return valid_;
  at_ = z;
  FrameSums sums;
  valid_ = evaluator_(start_ + units_ * z, &sums);
  if (valid_) Compress(sums);
  return valid_;
}

void FrameSumResidual::Compress(const FrameSums& sums) const {
  const Eigen::Index n = units_.cols();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(
      units_.transpose() * sums.information * units_);
  // If the frames do not determine a direction, the gradient along it is
  // rounding.
  const double least = 1e-14 * eigen.eigenvalues()[n - 1];
  const Eigen::VectorXd root = eigen.eigenvalues().cwiseMax(0).cwiseSqrt();
  residuals_ =
      eigen.eigenvectors().transpose() * (units_.transpose() * sums.gradient);
  for (Eigen::Index k = 0; k < n; ++k) {
    residuals_[k] =
        eigen.eigenvalues()[k] > least ? residuals_[k] / root[k] : 0;
  }
  const double rest = 2 * sums.cost - residuals_.squaredNorm();
  residuals_.conservativeResize(n + 1);
  residuals_[n] = std::sqrt(std::max(0.0, rest));
  jacobian_.setZero(n + 1, n);
  jacobian_.topRows(n) = root.asDiagonal() * eigen.eigenvectors().transpose();
}

bool FrameSumResidual::Evaluate(double const* const* parameters,
                                double* residuals, double** jacobians) const {
  const Eigen::Index n = units_.cols();
  if (!EvaluateAt(Eigen::Map<const Eigen::VectorXd>(parameters[0], n))) {
    return false;
  }
  Eigen::Map<Eigen::VectorXd>(residuals, n + 1) = residuals_;
  if (jacobians != nullptr && jacobians[0] != nullptr) {
    Eigen::Map<
        Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(
        jacobians[0], n + 1, n) = jacobian_;
  }
  return true;
}

}  // namespace finray
