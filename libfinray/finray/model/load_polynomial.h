#ifndef FINRAY_MODEL_LOAD_POLYNOMIAL_H_
#define FINRAY_MODEL_LOAD_POLYNOMIAL_H_

#include "finray/ladder/round_up.h"

namespace finray {

/// Several values as polynomials of a load,
///
///   v(l, f) = sum_ij c_ij P_i(l) Q_j(f),
///
/// as a plain array with the values innermost, so that vector lanes are values.
/// Terms that are high in both directions are small: each i has its own number
/// of j.
struct LoadPolynomial {
  /// The number of values is a multiple of this.
  static constexpr int kPadding = 4;
  static constexpr int Padded(int values) { return RoundUp(values, kPadding); }

  int arc_terms;
  const int* force_terms;  ///< of each arc term
  int values;
  const double* c;  ///< [i][j][value]
};

/// P_i and Q_j of a load and their derivatives.
struct PolynomialBasis {
  static constexpr int kMostTerms = 16;
  double by[2][kMostTerms][2];  ///< [derivative][term][0 by l, 1 by f]
};

/// Evaluates all values. `set` counts from the best instruction set of this
/// machine.
void EvaluateValues(const LoadPolynomial& polynomial,
                    const PolynomialBasis& basis, double* values, int set = 0);

/// Evaluates v, dv/dl and dv/df of all values, in this order: 3 x values.
void EvaluateGradients(const LoadPolynomial& polynomial,
                       const PolynomialBasis& basis, double* gradients,
                       int set = 0);

}  // namespace finray

#endif  // FINRAY_MODEL_LOAD_POLYNOMIAL_H_
