#include "finray/perception/beam_bound.h"

#include <gtest/gtest.h>

#include "perception/touch_fixture.h"

namespace finray {
namespace {

TEST(BeamBoundTest, BeamsHoldTheOutlineIn) {
  const Outline circle(CircleOutline{18});
  const ConvexCurve larger(NormalGrid(90), {20, 0},
                           Eigen::VectorXd::Constant(90, 20));
  const auto bounds =
      FindBeamBounds(ExactTouches(circle, 12), larger, 0.02, 30);
  ASSERT_FALSE(bounds.empty());
  for (const BeamBound& bound : bounds) {
    EXPECT_NEAR(bound.beam_normal.norm(), 1, 1e-12);
    // The finger is on the far side of the beam.
    EXPECT_GT(bound.beam_normal.dot(bound.beam_point_mm), 0);
  }
  EXPECT_TRUE(FindBeamBounds(ExactTouches(circle, 12),
                             ConvexCurve(NormalGrid(90), {17, 0},
                                         Eigen::VectorXd::Constant(90, 17)),
                             0.02, 30)
                  .empty());
}

}  // namespace
}  // namespace finray
