#include "finray/model/load_polynomial.h"

#include "finray/ladder/instruction_set.h"

namespace finray {

// Each compilation of load_polynomial_kernel.cc has one of these.
using Evaluate = void(const LoadPolynomial& polynomial,
                      const PolynomialBasis& basis, double* results);
inline namespace generic {
Evaluate ValuesOf, GradientsOf;
}
namespace avx2 {
Evaluate ValuesOf, GradientsOf;
}
namespace avx512 {
Evaluate ValuesOf, GradientsOf;
}

void EvaluateValues(const LoadPolynomial& polynomial,
                    const PolynomialBasis& basis, double* values, int set) {
  static constexpr Evaluate* kEvaluate[] = FINRAY_COMPILATIONS(ValuesOf);
  kEvaluate[BestInstructionSet() + set](polynomial, basis, values);
}

void EvaluateGradients(const LoadPolynomial& polynomial,
                       const PolynomialBasis& basis, double* gradients,
                       int set) {
  static constexpr Evaluate* kEvaluate[] = FINRAY_COMPILATIONS(GradientsOf);
  kEvaluate[BestInstructionSet() + set](polynomial, basis, gradients);
}

}  // namespace finray
