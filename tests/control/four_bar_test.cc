#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "finray/control/drive.h"

namespace finray {
namespace {

using Eigen::Vector2d;

const FourBarJoints kParallelogram = {{0, 0}, {0, 60}, {40, 0}, {40, 60}};

// A parallelogram's coupler moves on a circle and does not turn.
TEST(FourBarTest, Parallelogram) {
  const FourBar linkage(kParallelogram);
  for (const double angle : {-0.8, 0.0, 0.3, 0.9}) {
    const auto pose = linkage.Coupler(angle);
    ASSERT_TRUE(pose);
    EXPECT_NEAR(pose->s, 0, 1e-12);
    EXPECT_NEAR(pose->t.x(), -60 * std::sin(angle), 1e-10);
    EXPECT_NEAR(pose->t.y(), 60 * std::cos(angle) - 60, 1e-10);
  }
}

// A general linkage keeps its lengths at every angle.
TEST(FourBarTest, LinksKeepTheirLengths) {
  const FourBarJoints joints = {{0, 0}, {5, 30}, {45, -4}, {62, 41}};
  const FourBar linkage(joints);
  for (double angle = -0.5; angle <= 0.5; angle += 0.1) {
    const auto pose = linkage.Coupler(angle);
    ASSERT_TRUE(pose) << angle;
    const Vector2d b = *pose * joints.crank_joint_mm,
                   c = *pose * joints.rocker_joint_mm;
    EXPECT_NEAR(b.norm(), joints.crank_joint_mm.norm(), 1e-10);
    EXPECT_NEAR((c - joints.rocker_pivot_mm).norm(),
                (joints.rocker_joint_mm - joints.rocker_pivot_mm).norm(),
                1e-10);
    // The crank has turned by the angle.
    const double turned = std::atan2(b.y(), b.x()) - std::atan2(30, 5);
    EXPECT_NEAR(turned, angle, 1e-12);
  }
}

TEST(FourBarTest, SaysWhereItCannotBeClosed) {
  // Crank and coupler together do not reach this far.
  const FourBar linkage(FourBarJoints{{0, 0}, {30, 5}, {60, 0}, {55, 20}});
  EXPECT_TRUE(linkage.Coupler(0));
  EXPECT_FALSE(linkage.Coupler(M_PI - 0.2));
}

TEST(FourBarTest, RefusesLinkagesThatAreNone) {
  FourBarJoints joints = kParallelogram;
  joints.crank_joint_mm = joints.crank_pivot_mm;
  EXPECT_THROW(FourBar{joints}, std::invalid_argument);
  joints = {{0, 0}, {0, 60}, {40, 60}, {20, 60}};
  EXPECT_THROW(FourBar{joints}, std::invalid_argument);
}

}  // namespace
}  // namespace finray
