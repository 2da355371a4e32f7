// Invariants that every element must keep, whatever its scheme.

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "finray/ladder/rigid_link_element.h"
#include "finray/ladder/taylor_element.h"
#include "ladder/computed_element.h"
#include "statics/beam_ode.h"

namespace finray {
namespace {

constexpr double kEI_N_mm2 = 12500;

// Bent, pulled, pushed and unloaded starts, in all quadrants.
const std::vector<ElementStart>& Starts() {
  static const std::vector<ElementStart> starts = {
      {1.5, 120, -3, 7}, {M_PI / 2, -250, 0.5, -12}, {2.1, 30, 15, -4},
      {-0.7, 0, 2, 2},   {3.9, -400, -20, 9},        {0, 100, 0, 0},
      {1.95, 0, 0, 0},
  };
  return starts;
}

template <class Element>
class ElementInvariantTest : public testing::Test {
 public:
  static Element At(const ElementStart& start, double length) {
    return ComputedElement<Element>(start, kEI_N_mm2, length);
  }
};
using InvariantElements = testing::Types<TaylorElement<16>, RigidLinkElement<>>;
TYPED_TEST_SUITE(ElementInvariantTest, InvariantElements);

// M_1 = M_0 - (r_1 - r_0) x N, whatever the shape.
TYPED_TEST(ElementInvariantTest, MomentsBalance) {
  for (const ElementStart& start : Starts()) {
    const auto element = this->At(start, 8);
    const double* end = element.map().end;
    EXPECT_NEAR(end[3],
                start.moment_N_mm -
                    (end[0] * start.force_y_N - end[1] * start.force_x_N),
                1e-10);
  }
}

// Seen from its other end the same piece has t, M and N reversed.
TYPED_TEST(ElementInvariantTest, ReversalReturnsToTheStart) {
  for (const ElementStart& start : Starts()) {
    const auto there = this->At(start, 6);
    const double* end = there.map().end;
    const auto back = this->At(
        {end[2] + M_PI, -end[3], -start.force_x_N, -start.force_y_N}, 6);
    EXPECT_NEAR(back.map().end[0], -end[0], 1e-12);
    EXPECT_NEAR(back.map().end[1], -end[1], 1e-12);
    EXPECT_NEAR(back.map().end[2], start.theta_rad + M_PI, 1e-13);
    EXPECT_NEAR(back.map().end[3], -start.moment_N_mm, 1e-10);
  }
}

TYPED_TEST(ElementInvariantTest, ReadoutMeetsTheMapAtTheEnd) {
  for (const ElementStart& start : Starts()) {
    const auto element = this->At(start, 9);
    const auto end = PointOf(element, 9);
    EXPECT_NEAR(end[0], element.map().end[0], 1e-13);
    EXPECT_NEAR(end[1], element.map().end[1], 1e-13);
    EXPECT_NEAR(end[2], element.map().end[2], 1e-14);
    EXPECT_NEAR(element.AngleAt(9).theta_rad, element.map().end[2], 1e-14);
  }
}

TYPED_TEST(ElementInvariantTest, WithoutForceTheMomentBendsAnArc) {
  const auto element = this->At({0.3, 400, 0, 0}, 12);
  const double turn = 400 * 12 / kEI_N_mm2;
  const double* end = element.map().end;
  EXPECT_NEAR(end[2], 0.3 + turn, 1e-14);
  EXPECT_NEAR(end[3], 400, 1e-10);
  EXPECT_NEAR(std::atan2(end[1], end[0]), 0.3 + turn / 2, 1e-14);
}

// Extended precision, the inside of the element too.
TEST(TaylorElementInvariantTest, MatchesRungeKuttaEverywhere) {
  for (const ElementStart& start : Starts()) {
    for (const double length : {2.0, 6.0, 8.0}) {
      const auto element =
          ComputedElement<TaylorElement<16>>(start, kEI_N_mm2, length);
      for (const double share : {0.37, 1.0}) {
        const BeamOdeState exact = IntegrateBeam(
            {0, 0, start.theta_rad, start.moment_N_mm}, start.force_x_N,
            start.force_y_N, kEI_N_mm2, share * length, 400);
        const auto point = PointOf(element, share * length);
        EXPECT_NEAR(point[0], exact[0], 1e-12 * length);
        EXPECT_NEAR(point[1], exact[1], 1e-12 * length);
        EXPECT_NEAR(point[2], exact[2], 1e-12);
        EXPECT_NEAR(point[3], exact[3], 1e-10);
      }
    }
  }
}

// The paper's joint: k = EI / h at the middle of the segment, bent by the
// moment there.
TEST(RigidLinkElementInvariantTest, IsTwoHalfLinksAndAnElasticJoint) {
  const double length = 8;
  for (const ElementStart& start : Starts()) {
    const auto element =
        ComputedElement<RigidLinkElement<>>(start, kEI_N_mm2, length);
    const double* end = element.map().end;
    const double x = length / 2 * std::cos(start.theta_rad);
    const double y = length / 2 * std::sin(start.theta_rad);
    EXPECT_NEAR(kEI_N_mm2 / length * (end[2] - start.theta_rad),
                start.moment_N_mm - (x * start.force_y_N - y * start.force_x_N),
                1e-10);
    EXPECT_NEAR(end[0], x + length / 2 * std::cos(end[2]), 1e-12);
    EXPECT_NEAR(end[1], y + length / 2 * std::sin(end[2]), 1e-12);
  }
}

TEST(RigidLinkElementInvariantTest, LocalErrorIsOfOrderThree) {
  const ElementStart start{3.9, -400, -20, 9};
  const auto error = [&](double length, int row) {
    const auto element =
        ComputedElement<RigidLinkElement<>>(start, kEI_N_mm2, length);
    const BeamOdeState exact =
        IntegrateBeam({0, 0, start.theta_rad, start.moment_N_mm},
                      start.force_x_N, start.force_y_N, kEI_N_mm2, length, 400);
    return std::abs(element.map().end[row] - static_cast<double>(exact[row]));
  };
  for (int row = 0; row < 4; ++row) {
    EXPECT_NEAR(std::log2(error(0.5, row) / error(0.25, row)), 3, 0.2)
        << "row " << row;
  }
}

}  // namespace
}  // namespace finray
