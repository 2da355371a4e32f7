// Compiled once for every instruction set; see CMakeLists.txt.
#include <algorithm>

#include "finray/ladder/registers.h"
#include "finray/statics/load_polynomial.h"

namespace finray {
inline namespace FINRAY_ISA {
namespace {

constexpr int kWidth = std::min(kRegisterWidth, LoadPolynomial::kPadding);
using Some = Doubles<kWidth>;
using V = Some::Vector;

}  // namespace

void ValuesOf(const LoadPolynomial& polynomial, const PolynomialBasis& arc,
              const PolynomialBasis& force, double* values) {
  const int stride = polynomial.values;
  for (int first = 0; first < stride; first += kWidth) {
    const double* c = polynomial.c + first;
    V sum{};
    for (int i = 0; i < polynomial.arc_terms; ++i) {
      V along{}, odd{};
      int j = 0;
      for (; j + 1 < polynomial.force_terms; j += 2, c += 2 * stride) {
        along += force.by[0][j] * Some::Load(c);
        odd += force.by[0][j + 1] * Some::Load(c + stride);
      }
      for (; j < polynomial.force_terms; ++j, c += stride) {
        along += force.by[0][j] * Some::Load(c);
      }
      sum += arc.by[0][i] * (along + odd);
    }
    Some::Store(sum, values + first);
  }
}

void JetsOf(const LoadPolynomial& polynomial, const PolynomialBasis& arc,
            const PolynomialBasis& force, double* jets) {
  const int stride = polynomial.values;
  for (int first = 0; first < stride; first += kWidth) {
    const double* c = polynomial.c + first;
    V value{}, by_arc{}, by_force{}, by_arc_arc{}, by_arc_force{},
        by_force_force{};
    for (int i = 0; i < polynomial.arc_terms; ++i) {
      V along[3] = {};
      for (int j = 0; j < polynomial.force_terms; ++j, c += stride) {
        const V term = Some::Load(c);
        along[0] += force.by[0][j] * term;
        along[1] += force.by[1][j] * term;
        along[2] += force.by[2][j] * term;
      }
      value += arc.by[0][i] * along[0];
      by_arc += arc.by[1][i] * along[0];
      by_arc_arc += arc.by[2][i] * along[0];
      by_force += arc.by[0][i] * along[1];
      by_arc_force += arc.by[1][i] * along[1];
      by_force_force += arc.by[0][i] * along[2];
    }
    const V all[] = {value,      by_arc,       by_force,
                     by_arc_arc, by_arc_force, by_force_force};
    for (int k = 0; k < 6; ++k) Some::Store(all[k], jets + k * stride + first);
  }
}

}  // namespace FINRAY_ISA
}  // namespace finray
