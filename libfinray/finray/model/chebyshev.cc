#include "finray/model/chebyshev.h"

#include <cmath>

namespace finray {
namespace {

// The matrix that makes coefficients of values at the zeros of T_terms.
Eigen::MatrixXd Transform(int terms) {
  Eigen::MatrixXd of(terms, terms);
  for (int k = 0; k < terms; ++k) {
    for (int i = 0; i < terms; ++i) {
      // Zeros rise, cosines fall.
      of(k, terms - 1 - i) =
          (k == 0 ? 1.0 : 2.0) / terms * std::cos(M_PI * k * (i + 0.5) / terms);
    }
  }
  return of;
}

}  // namespace

void SetChebyshev(const Eigen::Array2d& x, const Eigen::Array2d& slope,
                  int terms, PolynomialBasis* basis) {
  using Both = Eigen::Array2d;
  const auto keep = [basis](int k, const Both& t, const Both& d) {
    Eigen::Map<Both>(basis->by[0][k]) = t;
    Eigen::Map<Both>(basis->by[1][k]) = d;
  };
  // T_k and T_k' of k - 2 and k - 1.
  Both t0 = Both::Ones(), d0 = Both::Zero();
  Both t1 = x, d1 = slope;
  keep(0, t0, d0);
  keep(1, t1, d1);
  const Both twice_x = 2 * x, twice_slope = 2 * slope;
  for (int k = 2; k < terms; ++k) {
    const Both t = twice_x * t1 - t0;
    const Both d = twice_x * d1 - d0 + twice_slope * t1;
    keep(k, t, d);
    t0 = t1, d0 = d1;
    t1 = t, d1 = d;
  }
}

double ChebyshevZero(int i, int terms) {
  return -std::cos(M_PI * (i + 0.5) / terms);
}

ChebyshevRows ChebyshevCoefficients(const ChebyshevRows& values, int u_terms,
                                    int w_terms) {
  const Eigen::MatrixXd by_u = Transform(u_terms), by_w = Transform(w_terms);
  ChebyshevRows along(values.rows(), values.cols());
  for (int i = 0; i < u_terms; ++i) {
    along.middleRows(i * w_terms, w_terms) =
        by_w * values.middleRows(i * w_terms, w_terms);
  }
  // A row of this has all values of all w terms.
  const Eigen::Index row = w_terms * values.cols();
  ChebyshevRows c(values.rows(), values.cols());
  Eigen::Map<ChebyshevRows>(c.data(), u_terms, row) =
      by_u * Eigen::Map<const ChebyshevRows>(along.data(), u_terms, row);
  return c;
}

}  // namespace finray
