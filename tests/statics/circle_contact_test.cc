// Checks of circle contacts beyond circle_contact_test.cc: dense clearance,
// the gradient of the stored energy, stale guesses, deep contact.

#include "finray/statics/circle_contact.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "finray/statics/shape.h"
#include "statics/gauss_legendre.h"
#include "test_finger.h"

namespace finray {
namespace {

using Eigen::Vector2d;

// A circle that overlaps the free (straight) finger by `depth` at height y.
Circle Touching(double height, double depth, double radius) {
  return {Vector2d(depth - radius, height), radius};
}

Vector2d PointAt(const Shape& shape, double arc) {
  const Section at = shape.At(Side::kFront, arc);
  return {at.x_mm, at.y_mm};
}

// Least distance from the front beam to the centre, sampled densely.
double Clearance(const EquilibriumSolver& solver, const PointContact& contact,
                 const Circle& circle) {
  const Shape shape(solver, {contact});
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i <= 2800; ++i) {
    least =
        std::min(least, (PointAt(shape, 0.05 * i) - circle.center_mm).norm());
  }
  return least;
}

void ExpectTangent(const EquilibriumSolver& solver, const PointContact& contact,
                   const Circle& circle) {
  const Shape shape(solver, {contact});
  const Section at = shape.At(Side::kFront, contact.arc_mm);
  const Vector2d to_centre = circle.center_mm - Vector2d(at.x_mm, at.y_mm);
  const Vector2d tangent(std::cos(at.theta_rad), std::sin(at.theta_rad));
  EXPECT_NEAR(to_centre.norm(), circle.radius_mm, 1e-9);
  EXPECT_NEAR(to_centre.dot(tangent), 0, 1e-9);
  // On the outer side: left of the tangent.
  EXPECT_GT(tangent.x() * to_centre.y() - tangent.y() * to_centre.x(), 0);
}

TEST(CircleContactTest, IsTangentAndDoesNotPenetrate) {
  const Finger finger = PaperFinger();
  for (const double radius : {10.0, 15.0, 30.0}) {
    for (const double height : {20.0, 45.0, 61.0, 80.0, 110.0}) {
      for (const double depth : {0.1, 1.0, 3.0, 6.0}) {
        for (const double friction : {0.0, 0.3}) {
          SCOPED_TRACE(testing::Message() << "R " << radius << ", y " << height
                                          << ", depth " << depth);
          const Circle circle = Touching(height, depth, radius);
          EquilibriumSolver solver(finger, {});
          PointContact contact;
          ASSERT_EQ(SolveCircleContact(circle, friction, &solver, &contact),
                    CircleContactStatus::kContact);
          EXPECT_GT(contact.normal_N, 0);
          EXPECT_EQ(contact.friction, friction);
          ExpectTangent(solver, contact, circle);
          // A stiff finger's base hardly yields; there a circle may be pressed
          // in until it touches twice, which one contact does not model.
          if (depth <= 3) {
            EXPECT_GT(Clearance(solver, contact, circle), radius - 1e-6);
          }
        }
      }
    }
  }
}

TEST(CircleContactTest, FirstTouchIsAtTheHeightOfTheCentre) {
  EquilibriumSolver solver(PaperFinger(), {});
  ASSERT_TRUE(solver.Solve({}));
  for (const double height : {7.3, 61.0, 118.9}) {
    const CircleTouch touch = FindTouch(Touching(height, 2.5, 15), solver);
    EXPECT_TRUE(touch.tangent);
    EXPECT_NEAR(touch.arc_mm, height, 1e-9);
    EXPECT_NEAR(touch.depth_mm, 2.5, 1e-9);
    EXPECT_NEAR(touch.distance_mm, 12.5, 1e-9);
    EXPECT_NEAR(touch.normal.x(), 1, 1e-12);
    EXPECT_NEAR(touch.normal.y(), 0, 1e-12);
  }
  EXPECT_NEAR(FindTouch(Touching(50, -4, 15), solver).depth_mm, -4, 1e-9);
}

// At a hair's depth force is depth over the linear compliance at that height.
TEST(CircleContactTest, StartsFromZeroForce) {
  EquilibriumSolver solver(PaperFinger(), {});
  ASSERT_TRUE(solver.SolveWithSensitivities({{70, 0, 0}}));
  const double compliance = solver.d_outputs()(solver.model().gauges(), 1);
  const double depth = 1e-4;
  PointContact contact;
  ASSERT_EQ(SolveCircleContact(Touching(70, depth, 15), 0, &solver, &contact),
            CircleContactStatus::kContact);
  EXPECT_NEAR(contact.arc_mm, 70, 1e-3);
  EXPECT_NEAR(contact.normal_N * compliance / depth, 1, 1e-3);
}

TEST(CircleContactTest, SaysWhenThereIsNoContact) {
  EquilibriumSolver solver(PaperFinger(), {});
  PointContact contact;
  const auto status = [&](const Circle& circle) {
    solver.Reset();
    contact = {};
    return SolveCircleContact(circle, 0, &solver, &contact);
  };
  EXPECT_EQ(status(Touching(70, -0.01, 15)), CircleContactStatus::kNoContact);
  EXPECT_EQ(status(Touching(70, -50, 15)), CircleContactStatus::kNoContact);
  EXPECT_EQ(status(Touching(-30, 5, 15)), CircleContactStatus::kNoContact);
  EXPECT_EQ(status(Touching(170, 5, 15)), CircleContactStatus::kNoContact);
  // Beyond an end but over its corner: met by the end, not by the side.
  EXPECT_EQ(status(Touching(145, 8, 15)), CircleContactStatus::kNoTangency);
  EXPECT_EQ(status(Touching(-5, 8, 15)), CircleContactStatus::kNoTangency);
  EXPECT_EQ(contact.normal_N, 0);
}

TEST(CircleContactTest, ForceGrowsWithDepthAndWarmEqualsCold) {
  for (const double radius : {8.0, 25.0}) {
    for (const double height : {35.0, 72.0, 105.0}) {
      EquilibriumSolver warm(PaperFinger(), {});
      PointContact warm_contact;
      double before = 0;
      for (double depth = 0.25; depth <= 8; depth += 0.25) {
        const Circle circle = Touching(height, depth, radius);
        ASSERT_EQ(SolveCircleContact(circle, 0.1, &warm, &warm_contact),
                  CircleContactStatus::kContact)
            << radius << ", " << height << ", " << depth;
        EquilibriumSolver cold(PaperFinger(), {});
        PointContact contact;
        ASSERT_EQ(SolveCircleContact(circle, 0.1, &cold, &contact),
                  CircleContactStatus::kContact)
            << radius << ", " << height << ", " << depth;
        EXPECT_NEAR(warm_contact.arc_mm, contact.arc_mm, 1e-6);
        EXPECT_NEAR(warm_contact.normal_N, contact.normal_N, 1e-7);
        EXPECT_GT(contact.normal_N, before);
        before = contact.normal_N;
      }
    }
  }
}

// A stale guess from an earlier frame must not stop a contact from ending or
// from being found elsewhere.
TEST(CircleContactTest, SurvivesAStaleGuess) {
  EquilibriumSolver solver(PaperFinger(), {});
  PointContact contact{20, 9, 0};
  EXPECT_EQ(SolveCircleContact(Touching(90, -1, 15), 0, &solver, &contact),
            CircleContactStatus::kNoContact);
  contact = {20, 9, 0};
  ASSERT_EQ(SolveCircleContact(Touching(90, 3, 15), 0, &solver, &contact),
            CircleContactStatus::kContact);
  PointContact cold_contact;
  EquilibriumSolver cold(PaperFinger(), {});
  ASSERT_EQ(SolveCircleContact(Touching(90, 3, 15), 0, &cold, &cold_contact),
            CircleContactStatus::kContact);
  EXPECT_NEAR(contact.arc_mm, cold_contact.arc_mm, 1e-6);
  EXPECT_NEAR(contact.normal_N, cold_contact.normal_N, 1e-7);
}

double StrainEnergy(const EquilibriumSolver& solver,
                    const PointContact& contact) {
  const Shape shape(solver, {contact});
  double energy = 0;
  for (const Side side : {Side::kFront, Side::kBack}) {
    const std::vector<double> stations = shape.Stations(side);
    for (std::size_t k = 0; k + 1 < stations.size(); ++k) {
      for (const QuadraturePoint& q :
           GaussLegendre(8, stations[k], stations[k + 1])) {
        const double moment = shape.At(side, q.at).moment_N_mm;
        energy +=
            q.weight * moment * moment / (2 * solver.model().stiffness(side));
      }
    }
  }
  return energy;
}

// Without friction the force on the circle is the slope of the stored energy
// as its centre moves.
TEST(CircleContactTest, ForceIsTheGradientOfTheStoredEnergy) {
  constexpr double kStep = 1e-3;
  for (const double radius : {10.0, 30.0}) {
    for (const double height : {40.0, 85.0}) {
      const Circle circle = Touching(height, 5, radius);
      EquilibriumSolver solver(PaperFinger(), {});
      const auto solve = [&](const Vector2d& move, PointContact* contact) {
        const Circle moved{circle.center_mm + move, radius};
        EXPECT_EQ(SolveCircleContact(moved, 0, &solver, contact),
                  CircleContactStatus::kContact);
        return StrainEnergy(solver, *contact);
      };
      PointContact contact;
      const Vector2d x(kStep, 0), y(0, kStep);
      const Vector2d slope =
          Vector2d(solve(x, &contact) - solve(-x, &contact),
                   solve(y, &contact) - solve(-y, &contact)) /
          (2 * kStep);
      solve(Vector2d::Zero(), &contact);
      const double theta = solver.contact_pose(0).z();
      const Vector2d force =
          contact.normal_N * Vector2d(std::sin(theta), -std::cos(theta));
      EXPECT_LT((slope - force).norm(), 1e-6 * force.norm());
    }
  }
}

TEST(CircleContactTest, FollowsASoftFingerDeep) {
  Finger finger = PaperFinger();
  finger.front_stiffness_N_mm2 = finger.back_stiffness_N_mm2 = 4400;
  EquilibriumSolver warm(finger, {});
  PointContact contact;
  double before = 0;
  for (double depth = 1; depth <= 30; depth += 1) {
    const Circle circle = Touching(66.5, depth, 20);
    ASSERT_EQ(SolveCircleContact(circle, 0, &warm, &contact),
              CircleContactStatus::kContact)
        << depth;
    ExpectTangent(warm, contact, circle);
    EXPECT_GT(contact.normal_N, before);
    before = contact.normal_N;
  }
  EquilibriumSolver cold(finger, {});
  PointContact cold_contact;
  ASSERT_EQ(SolveCircleContact(Touching(66.5, 30, 20), 0, &cold, &cold_contact),
            CircleContactStatus::kContact);
  EXPECT_NEAR(cold_contact.arc_mm, contact.arc_mm, 1e-6);
  EXPECT_NEAR(cold_contact.normal_N, contact.normal_N, 1e-7);
}

}  // namespace
}  // namespace finray
