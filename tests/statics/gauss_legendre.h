#ifndef FINRAY_TESTS_STATICS_GAUSS_LEGENDRE_H_
#define FINRAY_TESTS_STATICS_GAUSS_LEGENDRE_H_

#include <cmath>
#include <vector>

namespace finray {

/// Legendre polynomials P_0 .. P_degree at x in [-1, 1].
inline std::vector<double> Legendre(int degree, double x) {
  std::vector<double> p(degree + 1, 1.0);
  if (degree >= 1) p[1] = x;
  for (int j = 1; j < degree; ++j) {
    p[j + 1] = ((2 * j + 1) * x * p[j] - j * p[j - 1]) / (j + 1);
  }
  return p;
}

struct QuadraturePoint {
  double at;
  double weight;
};

/// Gauss-Legendre quadrature with n points on [a, b].
inline std::vector<QuadraturePoint> GaussLegendre(int n, double a, double b) {
  std::vector<QuadraturePoint> rule(n);
  for (int i = 0; i < n; ++i) {
    double x = -std::cos(M_PI * (i + 0.75) / (n + 0.5)), slope = 1;
    for (int k = 0; k < 8; ++k) {
      const std::vector<double> p = Legendre(n, x);
      slope = n * (x * p[n] - p[n - 1]) / (x * x - 1);
      x -= p[n] / slope;
    }
    rule[i] = {0.5 * (a + b) + 0.5 * (b - a) * x,
               (b - a) / ((1 - x * x) * slope * slope)};
  }
  return rule;
}

}  // namespace finray

#endif  // FINRAY_TESTS_STATICS_GAUSS_LEGENDRE_H_
