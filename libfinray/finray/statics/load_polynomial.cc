#include "finray/statics/load_polynomial.h"

#include "finray/ladder/instruction_set.h"

namespace finray {

// Each compilation of load_polynomial_kernel.cc has one of these.
using Evaluate = void(const LoadPolynomial& polynomial,
                      const PolynomialBasis& basis, double* results);
inline namespace generic {
Evaluate ValuesOf, JetsOf;
}
namespace avx2 {
Evaluate ValuesOf, JetsOf;
}
namespace avx512 {
Evaluate ValuesOf, JetsOf;
}

void EvaluateValues(const LoadPolynomial& polynomial,
                    const PolynomialBasis& basis, double* values, int set) {
  static constexpr Evaluate* kEvaluate[] = FINRAY_COMPILATIONS(ValuesOf);
  kEvaluate[BestInstructionSet() + set](polynomial, basis, values);
}

void EvaluateJets(const LoadPolynomial& polynomial,
                  const PolynomialBasis& basis, double* jets, int set) {
  static constexpr Evaluate* kEvaluate[] = FINRAY_COMPILATIONS(JetsOf);
  kEvaluate[BestInstructionSet() + set](polynomial, basis, jets);
}

}  // namespace finray
