#ifndef FINRAY_MODEL_CHEBYSHEV_H_
#define FINRAY_MODEL_CHEBYSHEV_H_

#include <Eigen/Core>

#include "finray/model/load_polynomial.h"

namespace finray {

// Series in Chebyshev's polynomials T_k of two arguments from -1 to 1,
//
//   v(u, w) = sum_ij c_ij T_i(u) T_j(w),   T_k(cos a) = cos(k a).

/// Sets T_k and its derivatives for all k below `terms`, which is from 2 to
/// kMostTerms. `x` are u and w, functions of l and f; `slope` are du/dl and
/// dw/df. The derivatives are by l and by f.
void SetChebyshev(const Eigen::Array2d& x, const Eigen::Array2d& slope,
                  int terms, PolynomialBasis* basis);

/// The zeros of T_terms, rising for i = 0 .. terms - 1.
double ChebyshevZero(int i, int terms);

/// Row i * w_terms + j holds (i, j) for all values, a column each.
using ChebyshevRows =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// The coefficients c_ij of the series with these values at the zeros (i, j) of
/// T_u_terms and T_w_terms.
ChebyshevRows ChebyshevCoefficients(const ChebyshevRows& values, int u_terms,
                                    int w_terms);

}  // namespace finray

#endif  // FINRAY_MODEL_CHEBYSHEV_H_
