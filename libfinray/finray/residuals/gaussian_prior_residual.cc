#include "finray/residuals/gaussian_prior_residual.h"

#include <Eigen/Eigenvalues>

namespace finray {

GaussianPriorResidual::GaussianPriorResidual(const Eigen::VectorXd& mean,
                                             const Eigen::MatrixXd& information,
                                             const std::vector<int>& sizes)
    : mean_(mean) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(information);
  root_ = eigen.eigenvalues().cwiseMax(0).cwiseSqrt().asDiagonal() *
          eigen.eigenvectors().transpose();
  set_num_residuals(static_cast<int>(mean.size()));
  *mutable_parameter_block_sizes() = sizes;
}

bool GaussianPriorResidual::Evaluate(double const* const* parameters,
                                     double* residuals,
                                     double** jacobians) const {
  using RowMajor =
      Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const auto& sizes = parameter_block_sizes();
  Eigen::Map<Eigen::VectorXd> r(residuals, num_residuals());
  r.setZero();
  int at = 0;
  for (std::size_t block = 0; block < sizes.size(); ++block) {
    const int size = sizes[block];
    const auto columns = root_.middleCols(at, size);
    r += columns * (Eigen::Map<const Eigen::VectorXd>(parameters[block], size) -
                    mean_.segment(at, size));
    if (jacobians != nullptr && jacobians[block] != nullptr) {
      // Maps of one column must be column-major; the order is the same.
      if (size == 1) {
        Eigen::Map<Eigen::VectorXd>(jacobians[block], num_residuals()) =
            columns;
      } else {
        Eigen::Map<RowMajor>(jacobians[block], num_residuals(), size) = columns;
      }
    }
    at += size;
  }
  return true;
}

}  // namespace finray
