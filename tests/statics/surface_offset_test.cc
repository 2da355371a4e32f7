// Contacts on a surface beside the beam.

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "finray/chain/se2.h"
#include "finray/finger/geometry.h"
#include "finray/objects/object_contact.h"
#include "finray/statics/equilibrium.h"
#include "statics/equilibrium_values.h"
#include "test_finger.h"

namespace finray {
namespace {

using Eigen::Vector2d;

Finger Thick(double front, double back) {
  Finger finger = PaperFinger();
  finger.front_surface_mm = front;
  finger.back_surface_mm = back;
  return finger;
}

TEST(SurfaceOffsetTest, ACircleActsLikeALargerOneWithout) {
  const double height = 1.2;
  const ObjectPose pose{{-9, 75}, 0};
  EquilibriumSolver thick(Thick(height, 0), {}), thin(PaperFinger(), {});
  const ObjectContact on_surface =
      SolveObjectContact({Outline(CircleOutline{15}), {}}, pose, 0, &thick);
  const ObjectContact on_beam = SolveObjectContact(
      {Outline(CircleOutline{15 + height}), {}}, pose, 0, &thin);
  ASSERT_EQ(on_surface.status, ObjectContactStatus::kContact);
  ASSERT_EQ(on_beam.status, ObjectContactStatus::kContact);
  ASSERT_EQ(on_surface.contacts.size(), on_beam.contacts.size());
  EXPECT_GT(on_beam.contacts[0].normal_N, 1);
  EXPECT_NEAR(on_surface.contacts[0].arc_mm, on_beam.contacts[0].arc_mm, 1e-6);
  EXPECT_NEAR(on_surface.contacts[0].normal_N, on_beam.contacts[0].normal_N,
              1e-8);
  // Where they touch: one on the surface, the other on the beam.
  const Eigen::Vector3d pose_of[2] = {thick.contact_pose(0),
                                      thin.contact_pose(0)};
  EXPECT_NEAR((pose_of[0].head<2>() - pose_of[1].head<2>()).norm(), height,
              1e-8);
  EXPECT_NEAR((pose_of[0].head<2>() - pose.position_mm).norm(), 15, 1e-6);
}

// Reactions balance forces that act on the surface, on both beams.
TEST(SurfaceOffsetTest, ReactionsBalanceForcesOnTheSurface) {
  const Finger finger = Thick(1.5, 0.7);
  const std::vector<std::vector<PointContact>> loads = {
      {{52.3, 3, 0.4}, {90, 1, -0.3}},
      {{45, 6, 0.3}, {80, 2, 0.5, Side::kBack}}};
  for (const auto& contacts : loads) {
    EquilibriumSolver solver(finger, {});
    ASSERT_TRUE(solver.Solve(contacts));
    Vector2d force(0, 0);
    double moment = 0, on_beam = 0;
    for (const Side side : {Side::kFront, Side::kBack}) {
      const Eigen::Vector3d reaction = BaseReaction(solver, side);
      force += reaction.tail<2>();
      moment += reaction[0] + Cross(BeamBase(finger, side), reaction.tail<2>());
    }
    on_beam = moment;
    for (std::size_t c = 0; c < contacts.size(); ++c) {
      const Eigen::Vector3d pose = solver.contact_pose(static_cast<int>(c));
      const Vector2d pushed = ContactForce(contacts[c], pose.z());
      const double into = contacts[c].side == Side::kFront ? 1 : -1;
      const Vector2d outwards =
          into * Vector2d(-std::sin(pose.z()), std::cos(pose.z()));
      force += pushed;
      moment += Cross(pose.head<2>(), pushed);
      on_beam += Cross(
          pose.head<2>() - SurfaceOffset(finger, contacts[c].side) * outwards,
          pushed);
    }
    EXPECT_LT(force.norm(), 1e-8);
    EXPECT_LT(std::abs(moment), 1e-6);
    EXPECT_GT(std::abs(on_beam), 0.3);
  }
}

// Without friction the beam bends alike, and marks lie on it.
TEST(SurfaceOffsetTest, OnlyFrictionBendsOtherwise) {
  EquilibriumSolver thick(Thick(1.5, 0.7), {}), thin(PaperFinger(), {});
  const std::vector<PointContact> contacts = {{70, 5, 0},
                                              {39, 0, 0, Side::kFront, true}};
  ASSERT_TRUE(thick.Solve(contacts));
  ASSERT_TRUE(thin.Solve(contacts));
  EXPECT_LT((thick.outputs().head(4) - thin.outputs().head(4)).norm(), 1e-12);
  EXPECT_LT((thick.contact_pose(1) - thin.contact_pose(1)).norm(), 1e-10);
  EXPECT_NEAR((thick.contact_pose(0) - thin.contact_pose(0)).norm(), 1.5,
              1e-10);
  ASSERT_TRUE(thick.Solve({{70, 5, 0.5}}));
  ASSERT_TRUE(thin.Solve({{70, 5, 0.5}}));
  EXPECT_GT((thick.outputs().head(4) - thin.outputs().head(4)).norm(), 1e-4);
}

}  // namespace
}  // namespace finray
