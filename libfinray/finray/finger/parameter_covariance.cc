#include "finray/finger/parameter_covariance.h"

#include <Eigen/Eigenvalues>

namespace finray {

double ParameterCovariance::SmallestEigenvalue() const {
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(correlations,
                                                        Eigen::EigenvaluesOnly)
      .eigenvalues()[0];
}

Eigen::MatrixXd ParameterCovariance::Factor() const {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(correlations);
  return std.asDiagonal() * eigen.eigenvectors() *
         eigen.eigenvalues().cwiseMax(0).cwiseSqrt().asDiagonal();
}

}  // namespace finray
