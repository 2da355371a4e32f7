#include "finray/calib/analysis/f_distribution.h"

#include <cmath>
#include <limits>

namespace finray {
namespace {

// Computes I_x(a, b). It converges fast for x < (a + 1) / (a + b + 2).
double IncompleteBeta(double a, double b, double x) {
  if (x <= 0) return 0;
  if (x >= 1) return 1;
  if (x > (a + 1) / (a + b + 2)) return 1 - IncompleteBeta(b, a, 1 - x);
  const double front =
      std::exp(std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b) +
               a * std::log(x) + b * std::log1p(-x)) /
      a;
  // This is Lentz's method for 1 / (1 + d_1 / (1 + d_2 / (1 + ...))).
  constexpr double kTiny = 1e-300, kEnough = 1e-15;
  double value = 1, c = 1, d = 0;
  for (int i = 0; i < 1000; ++i) {
    const int m = i / 2;
    const double term =
        i == 0 ? 1
        : i % 2 == 0
            ? m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m))
            : -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1));
    d = 1 + term * d;
    if (std::abs(d) < kTiny) d = kTiny;
    d = 1 / d;
    c = 1 + term / c;
    if (std::abs(c) < kTiny) c = kTiny;
    value *= c * d;
    if (i > 0 && std::abs(c * d - 1) < kEnough) break;
  }
  return front * (value - 1);
}

}  // namespace

double FTail(double f, int d1, int d2) {
  if (d1 < 1 || d2 < 1 || std::isnan(f)) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  if (f <= 0) return 1;
  return IncompleteBeta(0.5 * d2, 0.5 * d1, d2 / (d2 + d1 * f));
}

}  // namespace finray
