#include "finray/estimation/chi_squared.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace finray {

double ChiSquaredTail(double chi2, int dof) {
  if (dof < 1 || std::isnan(chi2)) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  const double x = 0.5 * std::max(chi2, 0.0);
  if (x == 0) return 1;
  if (std::isinf(x)) return 0;
  // Q(a + 1, x) = Q(a, x) + x^a e^-x / Gamma(a + 1), from Q(0, x) = 0 or
  // Q(1/2, x) = erfc(sqrt x).
  const bool odd = dof % 2 == 1;
  double a = odd ? 0.5 : 0;
  double tail = odd ? std::erfc(std::sqrt(x)) : 0;
  double term = std::exp(-x) * (odd ? 2 * std::sqrt(x / M_PI) : 1);
  for (; a + 0.5 < 0.5 * dof; a += 1) {
    tail += term;
    term *= x / (a + 1);
  }
  return std::min(1.0, tail);
}

}  // namespace finray
