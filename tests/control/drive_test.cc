#include "finray/control/drive.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace finray {
namespace {

constexpr ActuatorSettings kSettings = {0.05, 0.13, 0.03, 50};

TEST(ActuatorTest, MovesAfterTheDelay) {
  Actuator drive(kSettings, 1);
  drive.Command(0, 2);
  EXPECT_DOUBLE_EQ(drive.AdvanceTo(0.1299), 1);
  // A way of 1 mm is below 50 mm/s * 30 ms: an exponential from the start.
  EXPECT_NEAR(drive.AdvanceTo(0.16), 2 - std::exp(-1), 1e-12);
}

TEST(ActuatorTest, IsLimitedInSpeed) {
  Actuator drive(kSettings, 0);
  drive.Command(0, 11.5);
  // 10 mm at 50 mm/s, then 1.5 mm exponentially.
  EXPECT_NEAR(drive.AdvanceTo(0.13 + 0.1), 5, 1e-12);
  EXPECT_NEAR(drive.AdvanceTo(0.13 + 0.2 + 0.03), 11.5 - 1.5 * std::exp(-1),
              1e-12);
}

// The motion does not depend on the times at which it is read.
TEST(ActuatorTest, IsIntegratedExactly) {
  Actuator coarse(kSettings, 0), fine(kSettings, 0);
  for (int k = 0; k < 20; ++k) {
    const double position = 8 * std::sin(0.7 * k);
    coarse.Command(0.05 * k, position);
    fine.Command(0.05 * k, position);
    for (int i = 1; i <= 10; ++i) fine.AdvanceTo(0.05 * k + 0.005 * i);
  }
  EXPECT_NEAR(coarse.AdvanceTo(1.0), fine.AdvanceTo(1.0), 1e-12);
}

TEST(ActuatorTest, PredictionLooksAheadOnly) {
  Actuator drive(kSettings, 0);
  drive.Command(0, 1);
  const double later = drive.PredictAt(0.2);
  EXPECT_GT(later, 0.5);
  EXPECT_DOUBLE_EQ(drive.AdvanceTo(0.1), 0);
  EXPECT_NEAR(drive.AdvanceTo(0.2), later, 1e-12);
}

// The command is right although others are still in flight.
TEST(ActuatorTest, CommandForArrivesInTime) {
  Actuator drive(kSettings, 0);
  drive.Command(0, 0.5);
  drive.Command(0.05, -0.2);
  drive.AdvanceTo(0.1);
  drive.Command(0.1, drive.CommandFor(0.1, 0.7));
  EXPECT_NEAR(drive.AdvanceTo(0.1 + 0.13 + 0.05), 0.7, 1e-12);
}

TEST(ActuatorTest, MeasuredPositionReplacesItsOwn) {
  Actuator drive(kSettings, 0);
  drive.AdvanceTo(1);
  drive.CorrectTo(1);
  EXPECT_DOUBLE_EQ(drive.PredictAt(1), 1);
  // The command in force moves it back.
  EXPECT_NEAR(drive.AdvanceTo(1.03), std::exp(-1), 1e-12);
}

using Eigen::Vector2d;

const FourBar kParallelogram = {{0, 0}, {0, 60}, {40, 0}, {40, 60}};

// A parallelogram's coupler moves on a circle and does not turn.
TEST(FourBarTest, Parallelogram) {
  for (const double angle : {-0.8, 0.0, 0.3, 0.9}) {
    const auto pose = kParallelogram.Coupler(angle);
    ASSERT_TRUE(pose);
    EXPECT_NEAR(pose->s, 0, 1e-12);
    EXPECT_NEAR(pose->t.x(), -60 * std::sin(angle), 1e-10);
    EXPECT_NEAR(pose->t.y(), 60 * std::cos(angle) - 60, 1e-10);
  }
}

// A general linkage keeps its lengths at every angle.
TEST(FourBarTest, LinksKeepTheirLengths) {
  const FourBar joints = {{0, 0}, {5, 30}, {45, -4}, {62, 41}};
  for (double angle = -0.5; angle <= 0.5; angle += 0.1) {
    const auto pose = joints.Coupler(angle);
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
  const FourBar linkage{{0, 0}, {30, 5}, {60, 0}, {55, 20}};
  EXPECT_TRUE(linkage.Coupler(0));
  EXPECT_FALSE(linkage.Coupler(M_PI - 0.2));
}

TEST(FourBarTest, RefusesLinkagesThatAreNone) {
  FourBar joints = kParallelogram;
  joints.crank_joint_mm = joints.crank_pivot_mm;
  EXPECT_THROW(Mechanism{joints}, std::invalid_argument);
  joints = {{0, 0}, {0, 60}, {40, 60}, {20, 60}};
  EXPECT_THROW(Mechanism{joints}, std::invalid_argument);
}

TEST(MechanismTest, StageMovesTowardsTheObject) {
  const Mechanism stage;
  EXPECT_EQ(stage.fingers(), 1);
  EXPECT_EQ((*stage.FingerPose(3) * Vector2d(1, 2)), Vector2d(-2, 2));
  EXPECT_NEAR(stage.ApproachPerDrive(5, 80), 1, 1e-9);
}

// A growing drive closes the gripper, in whichever direction its crank turns.
TEST(MechanismTest, GripperCloses) {
  for (const double up : {60.0, -60.0}) {
    const Mechanism gripper(
        FourBar{{0, -75}, {0, -75 + up}, {40, -75}, {40, -75 + up}});
    EXPECT_EQ(gripper.fingers(), 2);
    EXPECT_NEAR(gripper.ApproachPerDrive(0, 80), 60, 1e-6);
    EXPECT_NEAR(gripper.ApproachPerDrive(0.5, 80), 60 * std::cos(0.5), 1e-6);
    EXPECT_NEAR(gripper.FingerPose(0.5)->t.x(), -60 * std::sin(0.5), 1e-10);
  }
}

TEST(MechanismTest, RefusesAGripperThatDoesNotClose) {
  EXPECT_THROW(Mechanism(FourBar{{0, 0}, {40, 0}, {0, 30}, {40, 30}}),
               std::invalid_argument);
}

}  // namespace
}  // namespace finray
