#include "finray/fit/linearized_frame.h"

#include <cmath>

namespace finray {

Eigen::Matrix2d PseudoInverse(const Eigen::Matrix2d& a) {
  // The eigenvalues of [p, q; q, s] have a closed form.
  const double mean = (a(0, 0) + a(1, 1)) / 2;
  const double half = (a(0, 0) - a(1, 1)) / 2, q = a(1, 0);
  const double radius = std::hypot(half, q);
  const double large = mean + radius;
  if (!(large > 0)) return Eigen::Matrix2d::Zero();
  // This form avoids the cancellation of mean - radius.
  const double small = (a(0, 0) * a(1, 1) - q * q) / large;
  if (small > 1e-12 * large) {
    Eigen::Matrix2d inverse;
    inverse << a(1, 1), -q, -q, a(0, 0);
    return inverse / (small * large);
  }
  // The eigenvector v of the large eigenvalue has v v' = (a - small) / (large -
  // small).
  return (a - small * Eigen::Matrix2d::Identity()) / (large - small) / large;
}

Eigen::MatrixXd EliminateContact(
    const Eigen::MatrixXd& c,
    const Eigen::Matrix<double, Eigen::Dynamic, 2>& e) {
  const Eigen::Matrix2d information = e.transpose() * e;
  if (information.isZero(0)) return c;
  return c - e * (PseudoInverse(information) * (e.transpose() * c));
}

void LinearizedFrame::Eliminate() {
  const Eigen::Matrix2d inverse =
      PseudoInverse(by_contact.transpose() * by_contact);
  const Eigen::Vector2d pull = by_contact.transpose() * WeightedResiduals();
  move.now = -inverse * pull;
  // Products of two rows or columns take longer to prepare than to make.
  move.by_parameter.noalias() =
      (-inverse * by_contact.transpose()).eval().lazyProduct(by_parameter);
  move.decrease = -0.5 * pull.dot(move.now);
  reduced = by_parameter;
  reduced.noalias() += by_contact.lazyProduct(move.by_parameter);
}

}  // namespace finray
