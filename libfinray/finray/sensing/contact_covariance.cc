#include "finray/sensing/contact_covariance.h"

#include <Eigen/Cholesky>
#include <cmath>
#include <limits>

namespace finray {
namespace {

// The least Cholesky pivot of the information matrix scaled to a unit diagonal.
// Smaller pivots are rounding errors of the derivatives.
constexpr double kLeastPivot = 1e-7;

}  // namespace

ContactMatrix CovarianceOf(const ContactMatrix& information) {
  const Eigen::Index size = information.rows();
  using Vector =
      Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 2 * kFittedContacts, 1>;
  const Vector scale = information.diagonal().cwiseSqrt().cwiseInverse();
  const ContactMatrix scaled =
      scale.asDiagonal() * information * scale.asDiagonal();
  const Eigen::LLT<ContactMatrix> llt(scaled);
  const bool regular = scaled.allFinite() && llt.info() == Eigen::Success &&
                       llt.matrixLLT().diagonal().minCoeff() > kLeastPivot;
  if (!regular) {
    ContactMatrix open = ContactMatrix::Zero(size, size);
    open.diagonal().setConstant(std::numeric_limits<double>::infinity());
    return open;
  }
  const ContactMatrix inverse = llt.solve(ContactMatrix::Identity(size, size));
  return scale.asDiagonal() * inverse * scale.asDiagonal();
}

}  // namespace finray
