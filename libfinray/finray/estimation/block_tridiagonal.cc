#include "finray/estimation/block_tridiagonal.h"

#include <Eigen/Cholesky>
#include <cmath>
#include <stdexcept>

namespace finray {
namespace {

// Added to a unit diagonal, so that what is open has a large variance rather
// than a division by zero.
constexpr double kRidge = 1e-12;

}  // namespace

BlockTridiagonal::BlockTridiagonal(const std::vector<int>& sizes) {
  for (std::size_t t = 0; t < sizes.size(); ++t) {
    first_.push_back(static_cast<int>(block_of_.size()));
    block_of_.insert(block_of_.end(), static_cast<std::size_t>(sizes[t]),
                     static_cast<int>(t));
    diagonal_.push_back(Eigen::MatrixXd::Zero(sizes[t], sizes[t]));
    gradient_.push_back(Eigen::VectorXd::Zero(sizes[t]));
    if (t > 0) {
      upper_.push_back(Eigen::MatrixXd::Zero(sizes[t - 1], sizes[t]));
    }
  }
}

void BlockTridiagonal::Add(const ceres::CRSMatrix& jacobian,
                           const std::vector<double>& residuals, int begin,
                           int end) {
  for (int row = begin; row < end; ++row) {
    for (int i = jacobian.rows[row]; i < jacobian.rows[row + 1]; ++i) {
      const int t = block_of_[jacobian.cols[i]];
      const int at = jacobian.cols[i] - first_[t];
      gradient_[t][at] += jacobian.values[i] * residuals[row];
      for (int k = jacobian.rows[row]; k < jacobian.rows[row + 1]; ++k) {
        const int other = block_of_[jacobian.cols[k]];
        const int other_at = jacobian.cols[k] - first_[other];
        const double product = jacobian.values[i] * jacobian.values[k];
        if (other == t) {
          diagonal_[t](at, other_at) += product;
        } else if (other == t + 1) {
          upper_[t](at, other_at) += product;
        } else if (other != t - 1) {
          throw std::invalid_argument(
              "a row reaches over more than two blocks of the chain");
        }
      }
    }
  }
}

std::vector<Eigen::MatrixXd> BlockTridiagonal::Marginals() const {
  const std::size_t count = diagonal_.size();
  std::vector<Eigen::MatrixXd> total = diagonal_;  // F_t + B_t - D_t
  for (std::size_t t = 1; t < count; ++t) {        // here F_t
    total[t] -= upper_[t - 1].transpose() * InverseInformation(total[t - 1]) *
                upper_[t - 1];
  }
  Eigen::MatrixXd behind;
  for (std::size_t t = count; t-- > 0;) {
    Eigen::MatrixXd backward = diagonal_[t];
    if (t + 1 < count) {
      const Eigen::MatrixXd taken =
          upper_[t] * InverseInformation(behind) * upper_[t].transpose();
      backward -= taken;
      total[t] -= taken;
    }
    behind = backward;
  }
  return total;
}

std::vector<Eigen::MatrixXd> BlockTridiagonal::Gains() const {
  std::vector<Eigen::MatrixXd> gains;
  Eigen::MatrixXd forward = diagonal_.front();
  for (std::size_t t = 0; t < upper_.size(); ++t) {
    gains.push_back(-InverseInformation(forward) * upper_[t]);
    forward = diagonal_[t + 1] + upper_[t].transpose() * gains.back();
  }
  return gains;
}

BlockTridiagonal::Marginal BlockTridiagonal::Last() const {
  Marginal last = {diagonal_.front(), gradient_.front()};
  for (std::size_t t = 1; t < diagonal_.size(); ++t) {
    const Eigen::MatrixXd passed =
        upper_[t - 1].transpose() * InverseInformation(last.information);
    last = {diagonal_[t] - passed * upper_[t - 1],
            gradient_[t] - passed * last.gradient};
  }
  return last;
}

Eigen::MatrixXd InverseInformation(const Eigen::MatrixXd& information) {
  const Eigen::Index size = information.rows();
  Eigen::VectorXd scale(size);
  for (Eigen::Index i = 0; i < size; ++i) {
    scale[i] = information(i, i) > 0 ? 1 / std::sqrt(information(i, i)) : 1;
  }
  Eigen::MatrixXd scaled =
      scale.asDiagonal() * information * scale.asDiagonal();
  scaled.diagonal().array() += kRidge;
  const Eigen::MatrixXd inverse =
      scaled.ldlt().solve(Eigen::MatrixXd::Identity(size, size));
  return scale.asDiagonal() * inverse * scale.asDiagonal();
}

}  // namespace finray
