#ifndef FINRAY_STATICS_CHEBYSHEV_H_
#define FINRAY_STATICS_CHEBYSHEV_H_

#include <Eigen/Core>

#include "finray/statics/load_polynomial.h"

namespace finray {

/// Series in Chebyshev's polynomials T_k of two arguments from -1 to 1,
///
///   v(u, w) = sum_ij c_ij T_i(u) T_j(w),   T_k(cos a) = cos(k a).
///
/// Sets T_k and its derivatives for all k below `terms`, at least 2. The
/// derivatives are by the quantities that the two arguments of `x` change with,
/// by `slope` each.
void SetChebyshev(const Eigen::Array2d& x, const Eigen::Array2d& slope,
                  int terms, PolynomialBasis* basis);

/// The zeros of T_terms, rising for i = 0 .. terms - 1.
double ChebyshevZero(int i, int terms);

/// A row for each (i, j), i before j, and a column for each value.
using ChebyshevRows =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// The coefficients c_ij of the series with these values at the zeros (i, j) of
/// T_u_terms and T_w_terms.
ChebyshevRows ChebyshevCoefficients(const ChebyshevRows& values, int u_terms,
                                    int w_terms);

}  // namespace finray

#endif  // FINRAY_STATICS_CHEBYSHEV_H_
