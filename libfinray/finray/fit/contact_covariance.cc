#include "finray/fit/contact_covariance.h"

#include <Eigen/Cholesky>
#include <cmath>
#include <limits>

namespace finray {
namespace {

// The least Cholesky pivot of the information matrix scaled to a unit diagonal.
// Smaller pivots are rounding errors of the derivatives.
constexpr double kLeastPivot = 1e-7;

template <class Matrix>
ContactMatrix InverseOf(const Matrix& information) {
  const Eigen::Index size = information.rows();
  const auto scale = information.diagonal().cwiseSqrt().cwiseInverse().eval();
  const Matrix scaled = scale.asDiagonal() * information * scale.asDiagonal();
  const Eigen::LLT<Matrix> llt(scaled);
  const bool regular = scaled.allFinite() && llt.info() == Eigen::Success &&
                       llt.matrixLLT().diagonal().minCoeff() > kLeastPivot;
  if (!regular) {
    ContactMatrix open = ContactMatrix::Zero(size, size);
    open.diagonal().setConstant(std::numeric_limits<double>::infinity());
    return open;
  }
  const Matrix inverse = llt.solve(Matrix::Identity(size, size));
  return scale.asDiagonal() * inverse * scale.asDiagonal();
}

}  // namespace

ContactMatrix CovarianceOf(const ContactMatrix& information) {
  // Most frames have one contact. The compiler unrolls its fixed size.
  return information.rows() == 2 ? InverseOf<Eigen::Matrix2d>(information)
                                 : InverseOf<ContactMatrix>(information);
}

}  // namespace finray
