#ifndef FINRAY_ESTIMATION_BLOCK_TRIDIAGONAL_H_
#define FINRAY_ESTIMATION_BLOCK_TRIDIAGONAL_H_

#include <ceres/crs_matrix.h>

#include <Eigen/Core>
#include <vector>

namespace finray {

/// The normal equations A = J'J, g = J'r of a chain of unknowns, where each row
/// of J reaches over one block of unknowns or over two that follow each other.
/// With D_t the diagonal blocks and U_t = A_{t, t+1},
///
///   F_t = D_t - U_{t-1}' F_{t-1}^-1 U_{t-1},
///   B_t = D_t - U_t B_{t+1}^-1 U_t',
///   (A^-1)_tt = (F_t + B_t - D_t)^-1.
///
/// F_t is what remains of D_t after elimination of all blocks before t, and B_t
/// of all behind t. Time grows with the number of blocks.
class BlockTridiagonal {
 public:
  /// The number of unknowns of each block; it may be 0.
  explicit BlockTridiagonal(const std::vector<int>& sizes);

  /// Adds the rows [begin, end) of J and r. Throws std::invalid_argument if a
  /// row reaches farther.
  void Add(const ceres::CRSMatrix& jacobian,
           const std::vector<double>& residuals, int begin, int end);

  /// F_t + B_t - D_t of every block: what all rows tell about it.
  std::vector<Eigen::MatrixXd> Marginals() const;

  /// -F_t^-1 U_t of every block but the last, so that
  /// (A^-1)_{t, t+1} = Gains()[t] (A^-1)_{t+1, t+1}.
  std::vector<Eigen::MatrixXd> Gains() const;

  struct Marginal {
    Eigen::MatrixXd information;
    Eigen::VectorXd gradient;
  };
  /// What is left for the last block when all before it are eliminated.
  Marginal Last() const;

  const Eigen::MatrixXd& diagonal(std::size_t t) const { return diagonal_[t]; }
  const Eigen::VectorXd& gradient(std::size_t t) const { return gradient_[t]; }

 private:
  std::vector<int> block_of_, first_;  // by column; the first column by block
  std::vector<Eigen::MatrixXd> diagonal_, upper_;
  std::vector<Eigen::VectorXd> gradient_;
};

/// The inverse of a small information matrix whose units may differ by orders
/// of magnitude. A direction that it leaves open has a variance of 1e12 in
/// units of what its own diagonal says.
Eigen::MatrixXd InverseInformation(const Eigen::MatrixXd& information);

}  // namespace finray

#endif  // FINRAY_ESTIMATION_BLOCK_TRIDIAGONAL_H_
