// Compiled once for every instruction set; see CMakeLists.txt.
#include <algorithm>

#include "finray/ladder/registers.h"
#include "finray/model/load_polynomial.h"

namespace finray {
inline namespace FINRAY_ISA {
namespace {

constexpr int kWidth = std::min(kRegisterWidth, LoadPolynomial::kPadding);
using Some = Doubles<kWidth>;
using V = Some::Vector;

// Evaluates `n` registers of values at a time from `first` on, as long as there
// are so many. Their sums do not wait for each other.
template <int n>
void SumValues(const LoadPolynomial& polynomial, const PolynomialBasis& basis,
               int* first, double* values) {
  const int stride = polynomial.values;
  for (; *first + n * kWidth <= stride; *first += n * kWidth) {
    const double* c = polynomial.c + *first;
    V sums[n] = {};
    for (int i = 0; i < polynomial.arc_terms; ++i) {
      for (int j = 0; j < polynomial.force_terms[i]; ++j, c += stride) {
        const double term = basis.by[0][i][0] * basis.by[0][j][1];
        for (int k = 0; k < n; ++k)
          sums[k] += term * Some::Load(c + k * kWidth);
      }
    }
    for (int k = 0; k < n; ++k) {
      Some::Store(sums[k], values + *first + k * kWidth);
    }
  }
}

template <int n>
void SumGradients(const LoadPolynomial& polynomial,
                  const PolynomialBasis& basis, int* first, double* gradients) {
  const int stride = polynomial.values;
  for (; *first + n * kWidth <= stride; *first += n * kWidth) {
    const double* c = polynomial.c + *first;
    V sums[3][n] = {};
    for (int i = 0; i < polynomial.arc_terms; ++i) {
      V along[2][n] = {};
      for (int j = 0; j < polynomial.force_terms[i]; ++j, c += stride) {
        for (int k = 0; k < n; ++k) {
          const V term = Some::Load(c + k * kWidth);
          for (int d = 0; d < 2; ++d) along[d][k] += basis.by[d][j][1] * term;
        }
      }
      for (int k = 0; k < n; ++k) {
        sums[0][k] += basis.by[0][i][0] * along[0][k];
        sums[1][k] += basis.by[1][i][0] * along[0][k];
        sums[2][k] += basis.by[0][i][0] * along[1][k];
      }
    }
    for (int d = 0; d < 3; ++d) {
      for (int k = 0; k < n; ++k) {
        Some::Store(sums[d][k], gradients + d * stride + *first + k * kWidth);
      }
    }
  }
}

}  // namespace

void ValuesOf(const LoadPolynomial& polynomial, const PolynomialBasis& basis,
              double* values) {
  int first = 0;
  SumValues<8>(polynomial, basis, &first, values);
  SumValues<4>(polynomial, basis, &first, values);
  SumValues<2>(polynomial, basis, &first, values);
  SumValues<1>(polynomial, basis, &first, values);
}

void GradientsOf(const LoadPolynomial& polynomial, const PolynomialBasis& basis,
                 double* gradients) {
  int first = 0;
  SumGradients<2>(polynomial, basis, &first, gradients);
  SumGradients<1>(polynomial, basis, &first, gradients);
}

}  // namespace FINRAY_ISA
}  // namespace finray
