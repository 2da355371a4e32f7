#include "finray/calib/eliminated_contact.h"

#include <Eigen/Eigenvalues>

namespace finray {

Eigen::Matrix2d PseudoInverse(const Eigen::Matrix2d& information) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(information);
  Eigen::Matrix2d inverse = Eigen::Matrix2d::Zero();
  for (int i = 0; i < 2; ++i) {
    const double value = eigen.eigenvalues()[i];
    if (value > 1e-12 * eigen.eigenvalues()[1] && value > 0) {
      inverse += eigen.eigenvectors().col(i) *
                 eigen.eigenvectors().col(i).transpose() / value;
    }
  }
  return inverse;
}

Eigen::MatrixXd EliminateContact(
    const Eigen::MatrixXd& c,
    const Eigen::Matrix<double, Eigen::Dynamic, 2>& e) {
  return c - e * (PseudoInverse(e.transpose() * e) * (e.transpose() * c));
}

Eigen::MatrixXd EliminateContact(const CalibrationProblem::Linearization& at,
                                 int first, int count) {
  return EliminateContact(at.by_parameter.middleRows(first, count),
                          at.by_contact.middleRows(first, count));
}

}  // namespace finray
