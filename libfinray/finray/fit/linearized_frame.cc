#include "finray/fit/linearized_frame.h"

#include <Eigen/Eigenvalues>
#include <cmath>

namespace finray {
namespace {

// Smaller eigenvalues are rounding, as a share of the largest one.
constexpr double kRounding = 1e-12;

ContactMatrix PseudoInverseOf(const ContactMatrix& a) {
  if (a.rows() == 2) return PseudoInverse(Eigen::Matrix2d(a));
  const Eigen::SelfAdjointEigenSolver<ContactMatrix> solver(a);
  const double least = kRounding * solver.eigenvalues().maxCoeff();
  const auto inverse = solver.eigenvalues().unaryExpr(
      [=](double value) { return value > least ? 1 / value : 0; });
  return solver.eigenvectors() * inverse.asDiagonal() *
         solver.eigenvectors().transpose();
}

}  // namespace

Eigen::Matrix2d PseudoInverse(const Eigen::Matrix2d& a) {
  // The eigenvalues of [p, q; q, s] have a closed form.
  const double mean = (a(0, 0) + a(1, 1)) / 2;
  const double half = (a(0, 0) - a(1, 1)) / 2, q = a(1, 0);
  const double radius = std::hypot(half, q);
  const double large = mean + radius;
  if (!(large > 0)) return Eigen::Matrix2d::Zero();
  // This form avoids the cancellation of mean - radius.
  const double small = (a(0, 0) * a(1, 1) - q * q) / large;
  if (small > kRounding * large) {
    Eigen::Matrix2d inverse;
    inverse << a(1, 1), -q, -q, a(0, 0);
    return inverse / (small * large);
  }
  // The eigenvector v of the large eigenvalue has v v' = (a - small) / (large -
  // small).
  return (a - small * Eigen::Matrix2d::Identity()) / (large - small) / large;
}

LinearizedFrame LinearizedFrame::WithRows(
    const std::vector<int>& indices) const {
  LinearizedFrame some;
  for (const int i : indices) {
    some.rows.push_back(rows[static_cast<std::size_t>(i)]);
  }
  some.residuals = residuals(indices);
  some.weights = weights(indices);
  some.by_parameter = by_parameter(indices, Eigen::all);
  some.by_contact = by_contact(indices, Eigen::all);
  return some;
}

ContactMatrix LinearizedFrame::Information() const {
  return by_contact.transpose().lazyProduct(by_contact);
}

void LinearizedFrame::Eliminate() { Eliminate(PseudoInverseOf(Information())); }

void LinearizedFrame::Eliminate(const ContactMatrix& inverse) {
  // Products of two rows or columns take longer to prepare than to make.
  scaled_.noalias() = by_contact.lazyProduct(-inverse);
  move.now.setZero(scaled_.cols());
  for (Eigen::Index i = 0; i < residuals.size(); ++i) {
    move.now += weights[i] * residuals[i] * scaled_.row(i).transpose();
  }
  move.decrease = 0.5 * move.now.dot(Information().lazyProduct(move.now));
  // Sums of rows: these lie in one piece, and there may be a hundred columns.
  move.by_parameter.setZero(scaled_.cols(), by_parameter.cols());
  reduced = by_parameter;
  for (Eigen::Index k = 0; k < scaled_.cols(); ++k) {
    auto by_k = move.by_parameter.row(k);
    for (Eigen::Index i = 0; i < by_parameter.rows(); ++i) {
      by_k += scaled_(i, k) * by_parameter.row(i);
    }
    for (Eigen::Index i = 0; i < by_parameter.rows(); ++i) {
      reduced.row(i) += by_contact(i, k) * by_k;
    }
  }
}

}  // namespace finray
