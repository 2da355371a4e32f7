#include "finray/objects/circle_centre.h"

#include <gtest/gtest.h>

#include "finray/objects/object_contact.h"
#include "test_finger.h"

namespace finray {
namespace {

TEST(CircleCentreTest, IsWhereTheCircleTouchesThatBend) {
  // A circle pressed into the finger: from its contact back to its centre.
  EquilibriumSolver solver(PaperFinger(), {});
  const RigidObject circle{Outline(CircleOutline{15}), std::nullopt};
  const ObjectPose pose{{-9, 64}, 0};
  const ObjectContact found = SolveObjectContact(circle, pose, 0, &solver);
  ASSERT_EQ(found.contacts.size(), 1u);
  const Eigen::Vector2d centre = CircleCentre(solver.contact_pose(0), 15);
  EXPECT_NEAR((centre - pose.position_mm).norm(), 0, 1e-8);
}

TEST(CircleCentreTest, DerivativeByAngle) {
  const Eigen::Vector3d at(3, 50, 1.3);
  constexpr double h = 1e-6;
  const Eigen::Vector2d difference =
      (CircleCentre(at + Eigen::Vector3d(0, 0, h), 12) -
       CircleCentre(at - Eigen::Vector3d(0, 0, h), 12)) /
      (2 * h);
  EXPECT_NEAR((CircleCentreByAngle(1.3, 12) - difference).norm(), 0, 1e-8);
}

}  // namespace
}  // namespace finray
