#include "finray/fit/contact_covariance.h"

#include <gtest/gtest.h>

#include <cmath>

namespace finray {
namespace {

ContactMatrix TwoByTwo(double a, double b, double c) {
  ContactMatrix matrix(2, 2);
  matrix << a, b, b, c;
  return matrix;
}

// One contact alone, and beside another that says nothing of it.
TEST(ContactCovarianceTest, ItIsTheInverse) {
  const ContactMatrix one = TwoByTwo(4, -3, 900);
  const double determinant = 4 * 900 - 9;
  const ContactMatrix exact =
      TwoByTwo(900 / determinant, 3 / determinant, 4 / determinant);
  EXPECT_TRUE(CovarianceOf(one).isApprox(exact, 1e-14));
  ContactMatrix two = ContactMatrix::Zero(4, 4);
  two.topLeftCorner<2, 2>() = TwoByTwo(1, 0.5, 2);
  two.bottomRightCorner<2, 2>() = one;
  const ContactMatrix covariance = CovarianceOf(two);
  EXPECT_TRUE((covariance.bottomRightCorner<2, 2>().isApprox(exact, 1e-14)));
  EXPECT_TRUE((covariance.topRightCorner<2, 2>().isZero(0)));
}

TEST(ContactCovarianceTest, AnUndeterminedDirectionLeavesAllVariancesInfinite) {
  for (const ContactMatrix& singular :
       {TwoByTwo(1, 2, 4), TwoByTwo(0, 0, 1), TwoByTwo(std::nan(""), 0, 1)}) {
    const ContactMatrix covariance = CovarianceOf(singular);
    EXPECT_TRUE(std::isinf(covariance(0, 0)));
    EXPECT_TRUE(std::isinf(covariance(1, 1)));
  }
}

}  // namespace
}  // namespace finray
