// Checks of objects against the front beam: tangency, clearance, the gradient
// of the stored energy, stale guesses, several contacts, springs.

#include "finray/objects/object_contact.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>

#include "objects/object_checks.h"
#include "test_finger.h"

namespace finray {
namespace {

using Eigen::Vector2d;

// Where a circle overlaps the free (straight) finger by `depth` at height y.
ObjectPose Touching(double height, double depth, double radius) {
  return {{depth - radius, height}, 0};
}

ObjectContact Solve(const RigidObject& object, const ObjectPose& pose,
                    double friction, EquilibriumSolver* solver,
                    const std::vector<PointContact>& guess = {}) {
  return SolveObjectContact(object, pose, friction, solver, guess);
}

TEST(ObjectContactTest, IsTangentAndDoesNotPenetrate) {
  const Finger finger = PaperFinger();
  for (const double radius : {10.0, 15.0, 30.0}) {
    for (const double height : {20.0, 45.0, 61.0, 80.0, 110.0}) {
      for (const double depth : {0.1, 1.0, 3.0, 6.0}) {
        for (const double friction : {0.0, 0.3}) {
          SCOPED_TRACE(testing::Message() << "R " << radius << ", y " << height
                                          << ", depth " << depth);
          EquilibriumSolver solver(finger, {});
          const ObjectPose pose = Touching(height, depth, radius);
          const ObjectContact found =
              Solve(Circle(radius), pose, friction, &solver);
          ASSERT_EQ(found.status, kContact);
          EXPECT_EQ(found.contacts[0].friction, friction);
          ExpectContact(Circle(radius), pose, found, solver);
        }
      }
    }
  }
}

// At a hair's depth force is depth over the linear compliance at that height.
TEST(ObjectContactTest, StartsFromZeroForce) {
  EquilibriumSolver solver(PaperFinger(), {});
  ASSERT_TRUE(solver.SolveWithSensitivities({{70, 0, 0}}));
  const double compliance = solver.d_outputs()(solver.model().gauges(), 1);
  const double depth = 1e-4;
  const ObjectContact found =
      Solve(Circle(15), Touching(70, depth, 15), 0, &solver);
  ASSERT_EQ(found.contacts.size(), 1u);
  EXPECT_NEAR(found.contacts[0].arc_mm, 70, 1e-3);
  EXPECT_NEAR(found.contacts[0].normal_N * compliance / depth, 1, 1e-3);
}

TEST(ObjectContactTest, SaysWhenThereIsNoContact) {
  EquilibriumSolver solver(PaperFinger(), {});
  const auto status = [&](const ObjectPose& pose) {
    solver.Reset();
    const ObjectContact found = Solve(Circle(15), pose, 0, &solver);
    EXPECT_TRUE(found.contacts.empty());
    return found.status;
  };
  const auto kNoContact = ObjectContactStatus::kNoContact;
  const auto kNoTangency = ObjectContactStatus::kNoTangency;
  EXPECT_EQ(status(Touching(70, -0.01, 15)), kNoContact);
  EXPECT_EQ(status(Touching(70, -50, 15)), kNoContact);
  EXPECT_EQ(status(Touching(-30, 5, 15)), kNoContact);
  EXPECT_EQ(status(Touching(170, 5, 15)), kNoContact);
  // Beyond an end but over its corner: met by the end, not by the side.
  EXPECT_EQ(status(Touching(145, 8, 15)), kNoTangency);
  EXPECT_EQ(status(Touching(-5, 8, 15)), kNoTangency);
}

TEST(ObjectContactTest, ForceGrowsWithDepthAndWarmEqualsCold) {
  for (const double radius : {8.0, 25.0}) {
    for (const double height : {35.0, 72.0, 105.0}) {
      EquilibriumSolver warm(PaperFinger(), {});
      ObjectContact followed;
      double before = 0;
      for (double depth = 0.25; depth <= 8; depth += 0.25) {
        SCOPED_TRACE(testing::Message() << "R " << radius << ", y " << height
                                        << ", depth " << depth);
        const ObjectPose pose = Touching(height, depth, radius);
        followed = Solve(Circle(radius), pose, 0.1, &warm, followed.contacts);
        EquilibriumSolver cold(PaperFinger(), {});
        const ObjectContact found = Solve(Circle(radius), pose, 0.1, &cold);
        ASSERT_EQ(followed.status, kContact);
        ASSERT_EQ(found.status, kContact);
        ASSERT_EQ(found.contacts.size(), followed.contacts.size());
        for (std::size_t c = 0; c < found.contacts.size(); ++c) {
          EXPECT_NEAR(followed.contacts[c].arc_mm, found.contacts[c].arc_mm,
                      1e-6);
          EXPECT_NEAR(followed.contacts[c].normal_N, found.contacts[c].normal_N,
                      1e-7);
        }
        const double force = TotalForce(found, cold).norm();
        EXPECT_GT(force, before);
        before = force;
      }
    }
  }
}

// A stale guess from an earlier frame must not stop a contact from ending or
// from being found elsewhere.
TEST(ObjectContactTest, SurvivesAStaleGuess) {
  EquilibriumSolver solver(PaperFinger(), {});
  const std::vector<PointContact> stale = {{20, 9, 0}};
  EXPECT_EQ(Solve(Circle(15), Touching(90, -1, 15), 0, &solver, stale).status,
            ObjectContactStatus::kNoContact);
  const ObjectContact found =
      Solve(Circle(15), Touching(90, 3, 15), 0, &solver, stale);
  EquilibriumSolver cold(PaperFinger(), {});
  const ObjectContact expected =
      Solve(Circle(15), Touching(90, 3, 15), 0, &cold);
  ASSERT_EQ(found.contacts.size(), 1u);
  ASSERT_EQ(expected.contacts.size(), 1u);
  EXPECT_NEAR(found.contacts[0].arc_mm, expected.contacts[0].arc_mm, 1e-6);
  EXPECT_NEAR(found.contacts[0].normal_N, expected.contacts[0].normal_N, 1e-7);
}

// Without friction the force and moment on the object are the slopes of the
// stored energy as it moves and turns.
TEST(ObjectContactTest, LoadIsTheGradientOfTheStoredEnergy) {
  constexpr double kStep = 1e-3;
  const std::vector<RigidObject> objects = {
      Circle(10),
      {Outline(EllipseOutline{12, 25}), {}},
      {Outline(EllipseOutline{9, 6}), {}},
      {Outline(RoundedPolygonOutline{{{-9, -6}, {8, -5}, {0, 9}}, 3}), {}}};
  for (const RigidObject& object : objects) {
    for (const double height : {40.0, 85.0}) {
      const double reach = object.outline.PointAt(-0.4).position_mm.norm();
      const ObjectPose pose{{5 - reach, height}, 0.4};
      EquilibriumSolver solver(PaperFinger(), {});
      ObjectContact found;
      const auto energy = [&](double x, double y, double angle) {
        const ObjectPose moved{pose.position_mm + Vector2d(x, y),
                               pose.angle_rad + angle};
        found = Solve(object, moved, 0, &solver);
        EXPECT_EQ(found.status, kContact);
        return StrainEnergy(solver, found.contacts);
      };
      const double turn = kStep / 20;
      const Eigen::Vector3d slope(
          (energy(kStep, 0, 0) - energy(-kStep, 0, 0)) / (2 * kStep),
          (energy(0, kStep, 0) - energy(0, -kStep, 0)) / (2 * kStep),
          (energy(0, 0, turn) - energy(0, 0, -turn)) / (2 * turn));
      energy(0, 0, 0);
      ASSERT_EQ(found.contacts.size(), 1u);
      const Vector2d force = TotalForce(found, solver);
      const Vector2d arm = solver.contact_pose(0).head<2>() - pose.position_mm;
      const double moment = arm.x() * force.y() - arm.y() * force.x();
      EXPECT_LT((slope.head<2>() - force).norm(), 1e-6 * force.norm());
      EXPECT_NEAR(slope.z(), moment, 1e-5 * force.norm() * arm.norm());
    }
  }
}

TEST(ObjectContactTest, EllipseOfEqualAxesEqualsTheCircle) {
  for (const double height : {33.0, 66.5, 101.0}) {
    EquilibriumSolver solver(PaperFinger(), {});
    const ObjectPose pose = Touching(height, 4, 14);
    const ObjectContact a = Solve(Circle(14), pose, 0.2, &solver);
    const ObjectContact b =
        Solve({Outline(EllipseOutline{14, 14}), {}}, pose, 0.2, &solver);
    ASSERT_EQ(a.contacts.size(), 1u);
    ASSERT_EQ(b.contacts.size(), 1u);
    EXPECT_NEAR(a.contacts[0].arc_mm, b.contacts[0].arc_mm, 1e-9);
    EXPECT_NEAR(a.contacts[0].normal_N, b.contacts[0].normal_N, 1e-9);
  }
}

TEST(ObjectContactTest, SwappedAxesAreAQuarterTurn) {
  EquilibriumSolver solver(PaperFinger(), {});
  const ObjectPose pose{{-6, 62}, 0.3};
  const ObjectPose turned{pose.position_mm, 0.3 + M_PI / 2};
  const ObjectContact a =
      Solve({Outline(EllipseOutline{10, 22}), {}}, pose, 0.1, &solver);
  const ObjectContact b =
      Solve({Outline(EllipseOutline{22, 10}), {}}, turned, 0.1, &solver);
  ASSERT_EQ(a.contacts.size(), 1u);
  ASSERT_EQ(b.contacts.size(), 1u);
  EXPECT_NEAR(a.contacts[0].arc_mm, b.contacts[0].arc_mm, 2e-9);
  EXPECT_NEAR(a.contacts[0].normal_N, b.contacts[0].normal_N, 2e-9);
}

TEST(ObjectContactTest, CornerEqualsACircleThere) {
  // A diamond whose corner at (8, 0) points at the finger.
  const RigidObject diamond{
      Outline(RoundedPolygonOutline{{{8, 0}, {0, 8}, {-8, 0}, {0, -8}}, 5}),
      {}};
  EquilibriumSolver solver(PaperFinger(), {});
  for (const double height : {40.0, 77.0}) {
    const ObjectPose pose{{-9, height}, 0};
    const ObjectContact a = Solve(diamond, pose, 0.2, &solver);
    const ObjectContact b = Solve(Circle(5), {{-1, height}, 0}, 0.2, &solver);
    ASSERT_EQ(a.contacts.size(), 1u);
    ASSERT_EQ(b.contacts.size(), 1u);
    EXPECT_NEAR(a.contacts[0].arc_mm, b.contacts[0].arc_mm, 1e-9);
    EXPECT_NEAR(a.contacts[0].normal_N, b.contacts[0].normal_N, 1e-9);
  }
}

TEST(ObjectContactTest, CirclesOnAGridSolve) {
  EquilibriumSolver solver(PaperFinger(), {});
  for (const double height : {25.0, 40.0, 55.0, 70.0, 85.0, 100.0}) {
    for (const double depth : {0.5, 2.0, 4.0, 6.0}) {
      const ObjectPose pose = Touching(height, depth, 20);
      const ObjectContact found = Solve(Circle(20), pose, 0, &solver);
      ASSERT_EQ(found.status, kContact) << height << ", " << depth;
      ExpectContact(Circle(20), pose, found, solver);
    }
  }
}

TEST(ObjectContactTest, FollowsASoftFingerDeep) {
  Finger finger = PaperFinger();
  finger.front_stiffness_N_mm2 = finger.back_stiffness_N_mm2 = 4400;
  EquilibriumSolver warm(finger, {});
  ObjectContact found;
  double before = 0;
  for (double depth = 1; depth <= 30; depth += 1) {
    const ObjectPose pose = Touching(66.5, depth, 20);
    found = Solve(Circle(20), pose, 0, &warm, found.contacts);
    ASSERT_EQ(found.status, kContact) << depth;
    ExpectContact(Circle(20), pose, found, warm);
    const double force = TotalForce(found, warm).norm();
    EXPECT_GT(force, before);
    before = force;
  }
  EquilibriumSolver cold(finger, {});
  const ObjectContact again =
      Solve(Circle(20), Touching(66.5, 30, 20), 0, &cold);
  EXPECT_NEAR(TotalForce(again, cold).norm(), before, 1e-6);
}

// A chain's kinks must not hide its nearest point.
TEST(ObjectContactTest, AChainHasANearestPoint) {
  Finger finger = PaperFinger();
  finger.ribs[2].length_mm += 0.3;
  EquilibriumSolver solver(finger, {Scheme::kRigidChain, 0});
  ASSERT_TRUE(solver.Solve({}));
  const Shape free(solver, {});
  const Outline circle(CircleOutline{11});
  for (int i = 0; i < 2000; ++i) {
    const ObjectPose pose = {{-25 + 0.011 * i, 20 + 0.05 * i}};
    EXPECT_FALSE(FindApproaches(free, 140, {}, circle, pose, 0).empty());
  }
}

}  // namespace
}  // namespace finray
