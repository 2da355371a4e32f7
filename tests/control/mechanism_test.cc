#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "finray/control/drive.h"

namespace finray {
namespace {

using Eigen::Vector2d;

TEST(MechanismTest, StageMovesTowardsTheObject) {
  const Mechanism stage;
  EXPECT_EQ(stage.fingers(), 1);
  EXPECT_EQ((*stage.FingerPose(3) * Vector2d(1, 2)), Vector2d(-2, 2));
  EXPECT_NEAR(stage.ApproachPerDrive(5, 80), 1, 1e-9);
}

// A growing drive closes the gripper, in whichever direction its crank turns.
TEST(MechanismTest, GripperCloses) {
  for (const double up : {60.0, -60.0}) {
    const Mechanism gripper(FourBar(
        FourBarJoints{{0, -75}, {0, -75 + up}, {40, -75}, {40, -75 + up}}));
    EXPECT_EQ(gripper.fingers(), 2);
    EXPECT_NEAR(gripper.ApproachPerDrive(0, 80), 60, 1e-6);
    EXPECT_NEAR(gripper.ApproachPerDrive(0.5, 80), 60 * std::cos(0.5), 1e-6);
    EXPECT_NEAR(gripper.FingerPose(0.5)->t.x(), -60 * std::sin(0.5), 1e-10);
  }
}

TEST(MechanismTest, RefusesAGripperThatDoesNotClose) {
  EXPECT_THROW(
      Mechanism(FourBar(FourBarJoints{{0, 0}, {40, 0}, {0, 30}, {40, 30}})),
      std::invalid_argument);
}

}  // namespace
}  // namespace finray
