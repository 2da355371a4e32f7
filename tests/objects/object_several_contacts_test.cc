// Objects that touch the front beam in more than one place, and objects on a
// spring.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "finray/objects/object_contact.h"
#include "finray/objects/tangency.h"
#include "objects/object_checks.h"
#include "test_finger.h"

namespace finray {
namespace {

using Eigen::Vector2d;

RigidObject Square(double half, double fillet) {
  return {Outline(RoundedPolygonOutline{
              {{-half, -half}, {half, -half}, {half, half}, {-half, half}},
              fillet}),
          {}};
}

// The finger bends between the corners of a flat side and leaves it.
TEST(ObjectSeveralContactsTest, FlatSideTouchesAtBothCorners) {
  const RigidObject square = Square(20, 2);
  for (const double friction : {0.0, 0.3}) {
    for (const double depth : {6.0, 12.0}) {
      EquilibriumSolver solver(PaperFinger(), {});
      const ObjectPose pose{{depth - 22, 70}, 0};
      const ObjectContact found =
          SolveObjectContact(square, pose, friction, &solver);
      ASSERT_EQ(found.status, kContact);
      ExpectContact(square, pose, found, solver);
      ASSERT_EQ(found.contacts.size(), 2u);
      EXPECT_LT(solver.contact_pose(0).y(), 51);
      EXPECT_GT(solver.contact_pose(1).y(), 89);
    }
  }
}

// The flat side of a sprung square bridges the tip, which is no side contact.
TEST(ObjectSeveralContactsTest, FlatSideOverTheTipIsNoTangency) {
  RigidObject square = Square(20, 2);
  square.spring = ObjectSpring{5, M_PI};
  EquilibriumSolver solver(PaperFinger(), {});
  EXPECT_EQ(SolveObjectContact(square, {{0, 138}, 0}, 0, &solver).status,
            ObjectContactStatus::kNoTangency);
}

// Turned by more than the beam bends, a square touches with one corner.
TEST(ObjectSeveralContactsTest, TurnedSquareTouchesAtOneCorner) {
  const RigidObject square = Square(20, 2);
  EquilibriumSolver solver(PaperFinger(), {});
  const ObjectPose pose{{-24, 70}, 0.5};
  const ObjectContact found = SolveObjectContact(square, pose, 0, &solver);
  ASSERT_EQ(found.status, kContact);
  EXPECT_EQ(found.contacts.size(), 1u);
  ExpectContact(square, pose, found, solver);
}

TEST(ObjectSeveralContactsTest, LargeCircleTouchesBetweenRibs) {
  EquilibriumSolver solver(PaperFinger(), {});
  const ObjectPose pose{{6 - 200, 70}, 0};
  const ObjectContact found = SolveObjectContact(Circle(200), pose, 0, &solver);
  ASSERT_EQ(found.status, kContact);
  EXPECT_EQ(found.contacts.size(), 3u);
  ExpectContact(Circle(200), pose, found, solver);
}

// Where a taut beam follows the outline it presses with N t / R per length,
// spread evenly, between two larger forces at the ends of the stretch.
TEST(ObjectSeveralContactsTest, TautBeamFollowsTheOutline) {
  constexpr double kRadius = 60;
  EquilibriumSolver solver(PaperFinger(), {});
  ObjectContact found;
  ObjectPose pose;
  for (double depth = 5; depth <= 7.5; depth += 0.25) {
    pose = {{depth - kRadius, 110}, 0};
    found =
        SolveObjectContact(Circle(kRadius), pose, 0, &solver, found.contacts);
    ASSERT_EQ(found.status, kContact) << depth;
    ExpectContact(Circle(kRadius), pose, found, solver);
  }
  const std::size_t count = found.contacts.size();
  ASSERT_GT(count, 6u);
  // Two contacts may share the force at an end. Those within stand for the
  // stretch midway to their neighbours.
  const auto arc = [&](std::size_t c) { return found.contacts[c].arc_mm; };
  double inner = 0;
  for (std::size_t c = 2; c + 2 < count; ++c) {
    inner += found.contacts[c].normal_N;
  }
  const double stretch =
      0.5 * (arc(count - 2) + arc(count - 3) - arc(2) - arc(1));
  const double middle = 0.5 * (arc(2) + arc(3));
  const Section at = Shape(solver, found.contacts).At(Side::kFront, middle);
  const double tension = at.force_x_N * std::cos(at.theta_rad) +
                         at.force_y_N * std::sin(at.theta_rad);
  std::printf("%zu contacts: %.4f N/mm, N t / R = %.4f N/mm\n", count,
              inner / stretch, tension / kRadius);
  EXPECT_NEAR(inner / stretch, tension / kRadius, 0.05 * tension / kRadius);
}

TEST(ObjectSeveralContactsTest, LoadIsTheGradientOfTheStoredEnergy) {
  constexpr double kStep = 1e-3;
  const RigidObject square = Square(20, 2);
  EquilibriumSolver solver(PaperFinger(), {});
  ObjectContact found;
  const auto energy = [&](double x, double y, double angle) {
    found = SolveObjectContact(square, {{-14 + x, 70 + y}, angle}, 0, &solver);
    EXPECT_EQ(found.contacts.size(), 2u);
    return StrainEnergy(solver, found.contacts);
  };
  const double turn = kStep / 20;
  const Eigen::Vector3d slope(
      (energy(kStep, 0, 0) - energy(-kStep, 0, 0)) / (2 * kStep),
      (energy(0, kStep, 0) - energy(0, -kStep, 0)) / (2 * kStep),
      (energy(0, 0, turn) - energy(0, 0, -turn)) / (2 * turn));
  energy(0, 0, 0);
  double moment = 0;
  for (int c = 0; c < 2; ++c) {
    const Eigen::Vector3d at = solver.contact_pose(c);
    const Vector2d arm = at.head<2>() - Vector2d(-14, 70);
    moment += found.contacts[c].normal_N *
              (-arm.x() * std::cos(at.z()) - arm.y() * std::sin(at.z()));
  }
  const Vector2d force = TotalForce(found, solver);
  EXPECT_LT((slope.head<2>() - force).norm(), 1e-5 * force.norm());
  EXPECT_NEAR(slope.z(), moment, 1e-4 * std::abs(moment));
}

// From within a corner the nearest side runs across the beam: the equations are
// singular there, and no force that they ask for is tried.
TEST(ObjectSeveralContactsTest, GivesUpWhereTheNormalRunsAlongTheBeam) {
  const RigidObject square = Square(20, 2);
  for (const double arc : {50.0, 50.001, 50.3, 51.0}) {
    EquilibriumSolver solver(PaperFinger(), {});
    Tangency tangency(square, 0, &solver);
    std::vector<PointContact> contacts = {{arc, 0, 0}};
    EXPECT_FALSE(tangency.Solve({{3.5 - 22, 70}, 0},
                                TangencyUnknowns::kPlacesAndForces, &contacts));
    EXPECT_EQ(tangency.equilibria(), 1) << arc;
  }
}

class ObjectSpringTest : public testing::TestWithParam<double> {
 protected:
  static RigidObject Sprung(double stiffness, double direction) {
    return {Outline(CircleOutline{15}), ObjectSpring{stiffness, direction}};
  }
  const double friction_ = GetParam();
  const ObjectPose pose_{{-10, 66}, 0};
};
INSTANTIATE_TEST_SUITE_P(Friction, ObjectSpringTest, testing::Values(0.0, 0.3));

// The spring carries the contact force along its direction, and where it has
// let the object go a rigid one would give the same equilibrium.
TEST_P(ObjectSpringTest, CarriesTheContactForce) {
  for (const double stiffness : {0.05, 2.0, 50.0}) {
    for (const double direction : {M_PI, 0.4, 2.5}) {
      EquilibriumSolver solver(PaperFinger(), {});
      const ObjectContact found = SolveObjectContact(
          Sprung(stiffness, direction), pose_, friction_, &solver);
      ASSERT_EQ(found.status, kContact);
      const Vector2d along(std::cos(direction), std::sin(direction));
      const Vector2d force = TotalForce(found, solver);
      EXPECT_NEAR(stiffness * found.displacement_mm, -along.dot(force),
                  1e-9 * force.norm());
      const ObjectPose moved{pose_.position_mm + found.displacement_mm * along,
                             0};
      ExpectContact(Circle(15), moved, found, solver);
      EquilibriumSolver other(PaperFinger(), {});
      const ObjectContact rigid =
          SolveObjectContact(Circle(15), moved, friction_, &other);
      ASSERT_EQ(rigid.contacts.size(), 1u);
      EXPECT_EQ(rigid.displacement_mm, 0);
      EXPECT_NEAR(found.contacts[0].arc_mm, rigid.contacts[0].arc_mm, 1e-7);
      EXPECT_NEAR(found.contacts[0].normal_N, rigid.contacts[0].normal_N, 1e-8);
    }
  }
}

TEST_P(ObjectSpringTest, TendsToARigidObject) {
  EquilibriumSolver solver(PaperFinger(), {});
  const PointContact rigid =
      SolveObjectContact(Circle(15), pose_, friction_, &solver).contacts.at(0);
  double before = 0;
  for (const double stiffness : {1e2, 1e4, 1e6, 1e8}) {
    const ObjectContact found =
        SolveObjectContact(Sprung(stiffness, M_PI), pose_, friction_, &solver);
    const double missing = rigid.normal_N - found.contacts.at(0).normal_N;
    if (before > 0) {
      EXPECT_NEAR(missing / before, 0.01, 1e-3);
    }
    before = missing;
  }
  const ObjectContact found =
      SolveObjectContact(Sprung(1e30, M_PI), pose_, friction_, &solver);
  EXPECT_NEAR(found.contacts.at(0).arc_mm, rigid.arc_mm, 1e-9);
  EXPECT_NEAR(found.contacts.at(0).normal_N, rigid.normal_N, 1e-9);
}

// The force on the given place is the slope of the energy of finger and spring.
TEST(ObjectSpringEnergyTest, ForceIsTheGradientOfTheWholeEnergy) {
  constexpr double kStep = 1e-3, kStiffness = 1.5, kDirection = 2.8;
  const RigidObject object{Outline(EllipseOutline{12, 20}),
                           ObjectSpring{kStiffness, kDirection}};
  EquilibriumSolver solver(PaperFinger(), {});
  ObjectContact found;
  const auto energy = [&](double x, double y) {
    found = SolveObjectContact(object, {{-7 + x, 66 + y}, 0.2}, 0, &solver);
    EXPECT_EQ(found.status, kContact);
    return StrainEnergy(solver, found.contacts) +
           0.5 * kStiffness * found.displacement_mm * found.displacement_mm;
  };
  const Vector2d slope((energy(kStep, 0) - energy(-kStep, 0)) / (2 * kStep),
                       (energy(0, kStep) - energy(0, -kStep)) / (2 * kStep));
  energy(0, 0);
  const Vector2d force = TotalForce(found, solver);
  EXPECT_LT((slope - force).norm(), 1e-6 * force.norm());
}

}  // namespace
}  // namespace finray
