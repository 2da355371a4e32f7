#include <gtest/gtest.h>

#include "finray/control/model_controller.h"
#include "finray/objects/object_contact.h"
#include "test_finger.h"

namespace finray {
namespace {

using Eigen::Vector2d;

const Pose<double> kHere = MakePose<double>(0, Vector2d::Zero());

// Contact statics find the force at the place that the model gives for it, at
// three heights, with and without friction.
TEST(PushModelTest, AgreesWithObjectContact) {
  const Finger finger = PaperFinger();
  const RigidObject circle{Outline(CircleOutline{15}), {}};
  for (const double friction : {0.0, 0.2}) {
    PushModel model(finger, 15, friction, {});
    EquilibriumSolver solver(finger, {});
    for (const double y : {50.0, 80.0, 100.0}) {
      for (const double force : {0.5, 4.0, 9.0}) {
        const auto push = model.At(kHere, y, force, y);
        ASSERT_TRUE(push) << y << " " << force;
        solver.Reset();
        const ObjectContact found = SolveObjectContact(
            circle, {{push->object_x_mm, y}, 0}, friction, &solver);
        ASSERT_EQ(found.contacts.size(), 1u);
        EXPECT_NEAR(found.contacts[0].normal_N, force, 1e-6);
        EXPECT_NEAR(found.contacts[0].arc_mm, push->arc_mm, 1e-5);
      }
    }
  }
}

// Compares df/dx with a difference of places.
TEST(PushModelTest, StiffnessIsTheSlopeOfTheForce) {
  PushModel model(PaperFinger(), 15, 0, {});
  for (const double y : {50.0, 80.0, 110.0}) {
    const auto push = model.At(kHere, y, 4, y);
    const auto more = model.At(kHere, y, 4.001, y);
    const auto less = model.At(kHere, y, 3.999, y);
    ASSERT_TRUE(push && more && less);
    const double slope = 0.002 / (more->object_x_mm - less->object_x_mm);
    EXPECT_NEAR(push->stiffness_N_per_mm / slope, 1, 1e-6) << y;
  }
}

// Near its tip the finger is more than twice as stiff as in its middle.
TEST(PushModelTest, StiffnessDependsOnTheHeight) {
  PushModel model(PaperFinger(), 15, 0, {});
  const double middle = model.At(kHere, 80, 6, 80)->stiffness_N_per_mm;
  const double top = model.At(kHere, 110, 6, 110)->stiffness_N_per_mm;
  EXPECT_NEAR(middle, 0.87, 0.05);
  EXPECT_GT(top, 2 * middle);
}

// The push does not depend on where the finger's base is.
TEST(PushModelTest, BaseMayBeAnywhere) {
  PushModel model(PaperFinger(), 15, 0, {});
  const Pose<double> moved = MakePose<double>(0.2, Vector2d(-7, 3));
  const auto centre = model.Centre(moved, 70, 5);
  ASSERT_TRUE(centre);
  const auto push = model.At(moved, centre->y(), 5, 75);
  ASSERT_TRUE(push);
  EXPECT_NEAR(push->object_x_mm, centre->x(), 1e-6);
  EXPECT_NEAR(push->arc_mm, 70, 1e-6);
}

TEST(PushModelTest, SaysWhereThereIsNoContact) {
  PushModel model(PaperFinger(), 15, 0, {});
  EXPECT_FALSE(model.At(kHere, 200, 3, 80));
  EXPECT_FALSE(model.At(kHere, -60, 3, 80));
}

}  // namespace
}  // namespace finray
