#include "finray/model/chebyshev.h"

#include <gtest/gtest.h>

#include <cmath>

namespace finray {
namespace {

// T_k(cos a) = cos(k a), and what follows for its derivatives.
TEST(ChebyshevTest, PolynomialsAndDerivativesAreThoseOfCosines) {
  constexpr int kTerms = PolynomialBasis::kMostTerms;
  const Eigen::Array2d slope = {0.3, 7};
  for (double a = 0.05; a < 3.1; a += 0.1) {
    const Eigen::Array2d angles = {a, 3.13 - a};
    PolynomialBasis basis;
    SetChebyshev(angles.cos(), slope, kTerms, &basis);
    for (int k = 0; k < kTerms; ++k) {
      for (int side = 0; side < 2; ++side) {
        const double b = angles[side], s = std::sin(b);
        const double d = k * std::sin(k * b) / s;
        EXPECT_NEAR(basis.by[0][k][side], std::cos(k * b), 1e-13);
        EXPECT_NEAR(basis.by[1][k][side], slope[side] * d, 1e-11 * slope[side]);
      }
    }
  }
}

TEST(ChebyshevTest, PolynomialsAreOneAtTheEnd) {
  PolynomialBasis basis;
  SetChebyshev({1, -1}, {1, 1}, 9, &basis);
  for (int k = 0; k < 9; ++k) {
    EXPECT_EQ(basis.by[0][k][0], 1);
    EXPECT_EQ(basis.by[0][k][1], k % 2 == 0 ? 1 : -1);
    EXPECT_EQ(basis.by[1][k][0], k * k);
  }
}

TEST(ChebyshevTest, CoefficientsAreThoseOfTheSampledPolynomial) {
  constexpr int kArcTerms = 5, kForceTerms = 4;
  ChebyshevRows samples(kArcTerms * kForceTerms, 2);
  for (int i = 0; i < kArcTerms; ++i) {
    for (int j = 0; j < kForceTerms; ++j) {
      const double u = ChebyshevZero(i, kArcTerms);
      const double w = ChebyshevZero(j, kForceTerms);
      // u^2 w = (T_0 + T_2) T_1 / 2, and 3 + u^4 = 3 + (3 T_0 + 4 T_2 + T_4) /
      // 8
      samples.row(i * kForceTerms + j) << u * u * w, 3 + u * u * u * u;
    }
  }
  const ChebyshevRows c =
      ChebyshevCoefficients(samples, kArcTerms, kForceTerms);
  ChebyshevRows exact = ChebyshevRows::Zero(kArcTerms * kForceTerms, 2);
  exact(1, 0) = exact(2 * kForceTerms + 1, 0) = 0.5;
  exact(0, 1) = 3 + 3.0 / 8;
  exact(2 * kForceTerms, 1) = 4.0 / 8;
  exact(4 * kForceTerms, 1) = 1.0 / 8;
  EXPECT_LT((c - exact).cwiseAbs().maxCoeff(), 1e-14);
}

}  // namespace
}  // namespace finray
