#include "finray/calib/solve/information_spectrum.h"

#include <lapacke.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <stdexcept>

namespace finray {
namespace {

// Eigenvalues below this are rounding if the diagonal of the matrix is 1.
constexpr double kRounding = 1e-13;

}  // namespace

InformationSpectrum::InformationSpectrum(const Eigen::MatrixXd& information) {
  const auto n = static_cast<lapack_int>(information.rows());
  if (n == 0) return;
  if (!information.allFinite()) {
    throw std::runtime_error(
        "the derivatives of the model by the parameters are not finite");
  }
  const Eigen::VectorXd root = information.diagonal().cwiseMax(0).cwiseSqrt();
  const Eigen::VectorXd size =
      root.unaryExpr([](double r) { return r > 0 ? 1 / r : 0; });
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> even(
      size.asDiagonal() * information * size.asDiagonal());
  const Eigen::VectorXd kept = even.eigenvalues().unaryExpr(
      [](double value) { return value > kRounding ? value : 0; });
  Eigen::MatrixXd factor = kept.cwiseSqrt().asDiagonal() *
                           even.eigenvectors().transpose() * root.asDiagonal();
  Eigen::VectorXd singular(n);
  Eigen::MatrixXd left(n, n), right(n, n);
  double stat[7];
  lapack_int rank[3];
  if (LAPACKE_dgejsv(LAPACK_COL_MAJOR, 'C', 'N', 'V', 'N', 'N', 'N', n, n,
                     factor.data(), n, singular.data(), left.data(), n,
                     right.data(), n, stat, rank) != 0) {
    throw std::runtime_error("the information of the data has no eigenvalues");
  }
  // LAPACK scales the singular values so that they do not overflow; this takes
  // the scale out.
  values = (stat[0] / stat[1] * singular).reverse().cwiseAbs2();
  vectors = right.rowwise().reverse();
}

Eigen::MatrixXd InUnits(const Eigen::MatrixXd& information,
                        const Eigen::VectorXd& unit) {
  return unit.asDiagonal() * information * unit.asDiagonal();
}

Eigen::MatrixXd DeterminedUnits(const Eigen::MatrixXd& information,
                                const Eigen::VectorXd& unit) {
  const InformationSpectrum spectrum(InUnits(information, unit));
  const auto weak =
      std::count_if(spectrum.values.begin(), spectrum.values.end(),
                    [](double value) { return value < kLeastMoved; });
  const Eigen::Index kept = unit.size() - weak;
  return unit.asDiagonal() * spectrum.vectors.rightCols(kept) *
         spectrum.values.tail(kept).cwiseSqrt().cwiseInverse().asDiagonal();
}

Eigen::MatrixXd BoundedCovariance(const Eigen::MatrixXd& information) {
  const InformationSpectrum spectrum(information);
  const Eigen::MatrixXd root =
      spectrum.vectors * spectrum.values.cwiseMax(kLeastInformation)
                             .cwiseSqrt()
                             .cwiseInverse()
                             .asDiagonal();
  return root * root.transpose();
}

}  // namespace finray
