#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "finray/ladder/rigid_link_element.h"
#include "finray/ladder/taylor_element.h"
#include "ladder/computed_element.h"

namespace finray {
namespace {

// A cantilever along +x with a dead load P in +y at its tip, in closed form by
// elliptic integrals (Bisshopp and Drucker 1945). L = 1, EI = 1.
struct Elastica {
  double load, tip_x, tip_y;
};

Elastica ByTipSlope(double slope) {
  const double k = std::sqrt((1 + std::sin(slope)) / 2);
  const double phi = std::asin(1 / (k * std::sqrt(2.0)));
  const double root = std::comp_ellint_1(k) - std::ellint_1(k, phi);
  const double load = root * root;
  return {load, std::sqrt(2 * std::sin(slope) / load),
          1 - 2 / root * (std::comp_ellint_2(k) - std::ellint_2(k, phi))};
}

Elastica ByLoad(double load) {
  double low = 1e-6, high = M_PI / 2 - 1e-9;
  for (int i = 0; i < 200; ++i) {
    const double middle = 0.5 * (low + high);
    (ByTipSlope(middle).load < load ? low : high) = middle;
  }
  return ByTipSlope(0.5 * (low + high));
}

// The same by marching elements from the clamp, the base moment being found by
// Newton so that the tip carries none.
template <class Element>
Elastica March(double load, int elements, double moment_guess) {
  double moment = moment_guess, x = 0, y = 0;
  for (int iteration = 0; iteration < 20; ++iteration) {
    ElementStart at = {0, moment, 0, load};
    double d_theta = 0, d_moment = 1;
    x = y = 0;
    for (int i = 0; i < elements; ++i) {
      const auto element = ComputedElement<Element>(at, 1, 1.0 / elements);
      const ElementMap& map = element.map();
      x += map.end[0];
      y += map.end[1];
      at.theta_rad = map.end[2];
      at.moment_N_mm = map.end[3];
      const auto& d = map.d_start;
      const double next = d[2][0] * d_theta + d[2][1] * d_moment;
      d_moment = d[3][0] * d_theta + d[3][1] * d_moment;
      d_theta = next;
    }
    const double step = -at.moment_N_mm / d_moment;
    moment += step;
    if (std::abs(step) < 1e-15 * moment) break;
  }
  return {load, x, y};
}

double Error(const Elastica& a, const Elastica& b) {
  return std::hypot(a.tip_x - b.tip_x, a.tip_y - b.tip_y);
}

TEST(CantileverTest, ClosedFormIsItself) {
  // Small loads: y = P L^3 / 3 EI; and a tabulated point of the large ones:
  // P L^2 / EI = 1 gives y = 0.30172 (Bisshopp and Drucker, Howell Table).
  EXPECT_NEAR(ByLoad(1e-3).tip_y, 1e-3 / 3, 1e-9);
  EXPECT_NEAR(ByLoad(1).tip_y, 0.30172, 1e-5);
}

TEST(CantileverTest, TaylorMeetsEllipticIntegrals) {
  std::printf("P L^2/EI   tip error / L (24 Taylor elements)\n");
  for (const double load : {0.1, 0.3, 1.0, 3.0, 5.0, 10.0, 20.0, 35.0, 50.0}) {
    const Elastica exact = ByLoad(load);
    const double error =
        Error(March<TaylorElement<16>>(load, 24, load * exact.tip_x), exact);
    std::printf("%8.1f   %.2e\n", load, error);
    EXPECT_LT(error, 1e-8) << load;
  }
}

TEST(CantileverTest, RigidChainIsOfOrderTwo) {
  std::printf("rigid_chain, P L^2/EI = 5:     n   tip error / L   order\n");
  const Elastica exact = ByLoad(5);
  double before = 0;
  for (int n = 10; n <= 1280; n *= 2) {
    const double error =
        Error(March<RigidLinkElement<>>(5, n, 5 * exact.tip_x), exact);
    const double order = before > 0 ? std::log2(before / error) : 0;
    std::printf("%33d   %.3e       %.3f\n", n, error, order);
    if (n >= 40) {
      EXPECT_NEAR(order, 2, 0.05);
    }
    before = error;
  }
  EXPECT_LT(before, 1e-6);
}

}  // namespace
}  // namespace finray
