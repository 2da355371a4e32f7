#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "finray/ladder/rigid_link_element.h"
#include "finray/ladder/taylor_element.h"
#include "ladder/computed_element.h"

namespace finray {
namespace {

using Taylor = TaylorElement<16>;

const ElementStart kStart = {1.3, 42.0, -3.1, 1.7};
constexpr double kStiffness = 9000, kLength = 11.5;
// Used by the stretching element only.
constexpr double kFlexibility = 2e-3;

// Central difference of f at 0 with step h.
double Slope(const std::function<double(double)>& f, double h) {
  return (f(h) - f(-h)) / (2 * h);
}

template <class Element>
class ElementTest : public testing::Test {};
using Elements =
    testing::Types<Taylor, TaylorElement<8>, TaylorElement<16, double, true>,
                   RigidLinkElement<>>;
TYPED_TEST_SUITE(ElementTest, Elements);

TYPED_TEST(ElementTest, DerivativesMatchFiniteDifferences) {
  const TypeParam element =
      ComputedElement<TypeParam>(kStart, kStiffness, kLength, kFlexibility);
  const ElementMap map = element.map();
  const double step[4] = {1e-5, 1e-2, 1e-4, 1e-4};
  for (int i = 0; i < 4; ++i) {
    const auto end = [&](ElementStart start, double stiffness, double length) {
      return ComputedElement<TypeParam>(start, stiffness, length, kFlexibility)
          .map()
          .end[i];
    };
    for (int p = 0; p < 4; ++p) {
      const auto at = [&](double d) {
        ElementStart s = kStart;
        (p == 0   ? s.theta_rad
         : p == 1 ? s.moment_N_mm
         : p == 2 ? s.force_x_N
                  : s.force_y_N) += d;
        return end(s, kStiffness, kLength);
      };
      const double expected = Slope(at, step[p]);
      EXPECT_NEAR(map.d_start[i][p], expected, 1e-8 + 1e-7 * std::abs(expected))
          << "row " << i << " by " << p;
    }
    const double by_stiffness = Slope(
        [&](double d) { return end(kStart, kStiffness + d, kLength); }, 1);
    const double by_length = Slope(
        [&](double d) { return end(kStart, kStiffness, kLength + d); }, 1e-4);
    EXPECT_NEAR(map.d_stiffness[i], by_stiffness,
                1e-10 + 1e-6 * std::abs(by_stiffness));
    EXPECT_NEAR(map.d_length[i], by_length, 1e-8 + 1e-7 * std::abs(by_length));
  }
}

TYPED_TEST(ElementTest, ReadoutDerivativesMatchFiniteDifferences) {
  constexpr double kOffset = 4.3;
  const TypeParam element =
      ComputedElement<TypeParam>(kStart, kStiffness, kLength, kFlexibility);
  const AngleReadout at = element.AngleAt(kOffset);
  const auto angle = [&](ElementStart start, double stiffness, double length,
                         double offset) {
    return ComputedElement<TypeParam>(start, stiffness, length, kFlexibility)
        .AngleAt(offset)
        .theta_rad;
  };
  const auto start_moved = [&](int p, double d) {
    ElementStart s = kStart;
    (p == 0   ? s.theta_rad
     : p == 1 ? s.moment_N_mm
     : p == 2 ? s.force_x_N
              : s.force_y_N) += d;
    return angle(s, kStiffness, kLength, kOffset);
  };
  for (int p = 0; p < 4; ++p) {
    EXPECT_NEAR(at.d_start[p],
                Slope([&](double d) { return start_moved(p, d); }, 1e-3), 2e-7);
  }
  EXPECT_NEAR(at.d_stiffness,
              Slope(
                  [&](double d) {
                    return angle(kStart, kStiffness + d, kLength, kOffset);
                  },
                  1),
              1e-11);
  EXPECT_NEAR(at.d_offset,
              Slope(
                  [&](double d) {
                    return angle(kStart, kStiffness, kLength, kOffset + d);
                  },
                  1e-3),
              1e-8);
  EXPECT_NEAR(at.d_length,
              Slope(
                  [&](double d) {
                    return angle(kStart, kStiffness, kLength + d, kOffset);
                  },
                  1e-3),
              1e-8);
}

TYPED_TEST(ElementTest, ZeroLengthIsTheIdentity) {
  const TypeParam element = ComputedElement<TypeParam>(kStart, kStiffness, 0);
  const ElementMap& map = element.map();
  EXPECT_EQ(map.end[0], 0);
  EXPECT_EQ(map.end[1], 0);
  EXPECT_EQ(map.end[2], kStart.theta_rad);
  EXPECT_DOUBLE_EQ(map.end[3], kStart.moment_N_mm);
  EXPECT_NEAR(map.d_length[0], std::cos(kStart.theta_rad), 1e-15);
  EXPECT_NEAR(map.d_length[2], kStart.moment_N_mm / kStiffness, 1e-15);
  EXPECT_EQ(element.AngleAt(0).theta_rad, kStart.theta_rad);
}

TEST(TaylorElementTest, DenseOutputKeepsThePendulumIntegral) {
  // M^2 / 2 EI + N . t is constant along a bay.
  const auto element = ComputedElement<Taylor>(kStart, kStiffness, kLength);
  const auto integral = [](double theta, double moment) {
    return moment * moment / (2 * kStiffness) +
           kStart.force_x_N * std::cos(theta) +
           kStart.force_y_N * std::sin(theta);
  };
  const double expected = integral(kStart.theta_rad, kStart.moment_N_mm);
  for (double offset = 0; offset <= kLength; offset += 0.5) {
    const auto at = PointOf(element, offset);
    EXPECT_NEAR(integral(at[2], at[3]), expected, 1e-12);
  }
}

}  // namespace
}  // namespace finray
