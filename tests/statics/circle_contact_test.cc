#include "finray/statics/circle_contact.h"

#include <gtest/gtest.h>

#include <cmath>

#include "finray/statics/shape.h"
#include "test_finger.h"

namespace finray {
namespace {

struct Solved {
  CircleContactStatus status;
  PointContact contact;
};

Solved Press(EquilibriumSolver* solver, double x, double y, double radius) {
  solver->Reset();
  Solved solved;
  solved.status =
      SolveCircleContact({{x, y}, radius}, 0, solver, &solved.contact);
  return solved;
}

TEST(CircleContactTest, TheBeamIsTangentToTheCircleAndOutsideIt) {
  EquilibriumSolver solver(PaperFinger(), {});
  for (const double radius : {8.0, 15.0, 40.0}) {
    for (const double y : {35.0, 60.0, 85.0, 105.0}) {
      double force_before = 0;
      for (const double depth : {0.01, 0.5, 2.0, 5.0}) {
        const Circle circle{{-radius + depth, y}, radius};
        const Solved solved = Press(&solver, circle.center_mm.x(), y, radius);
        ASSERT_EQ(solved.status, CircleContactStatus::kContact);
        EXPECT_GT(solved.contact.normal_N, force_before);
        force_before = solved.contact.normal_N;
        const Shape shape(solver, {solved.contact});
        const Section at = shape.At(Side::kFront, solved.contact.arc_mm);
        const Eigen::Vector2d r(at.x_mm - circle.center_mm.x(),
                                at.y_mm - circle.center_mm.y());
        const Eigen::Vector2d t(std::cos(at.theta_rad), std::sin(at.theta_rad));
        EXPECT_NEAR(r.norm(), radius, 1e-9);
        EXPECT_NEAR(r.dot(t), 0, 1e-9);
        EXPECT_GT(r.x(), 0);
        for (double arc = 0; arc <= 140; arc += 0.5) {
          const Section p = shape.At(Side::kFront, arc);
          EXPECT_GT(std::hypot(p.x_mm - circle.center_mm.x(),
                               p.y_mm - circle.center_mm.y()),
                    radius - 1e-6)
              << "arc " << arc;
        }
      }
    }
  }
}

TEST(CircleContactTest, FirstTouchAndBeyondTheEnds) {
  EquilibriumSolver solver(PaperFinger(), {});
  EXPECT_EQ(Press(&solver, -15.001, 70, 15).status,
            CircleContactStatus::kNoContact);
  EXPECT_EQ(Press(&solver, -14.999, 70, 15).status,
            CircleContactStatus::kContact);
  EXPECT_EQ(Press(&solver, -14, 160, 15).status,
            CircleContactStatus::kNoContact);
  EXPECT_EQ(Press(&solver, -10, 145, 15).status,
            CircleContactStatus::kNoTangency);
}

TEST(CircleContactTest, AWarmStartFindsTheSame) {
  EquilibriumSolver solver(PaperFinger(), {});
  const Solved cold = Press(&solver, -11, 77, 15);
  PointContact warm = Press(&solver, -13, 72, 15).contact;
  ASSERT_EQ(SolveCircleContact({{-11, 77}, 15}, 0, &solver, &warm),
            CircleContactStatus::kContact);
  EXPECT_NEAR(warm.arc_mm, cold.contact.arc_mm, 1e-8);
  EXPECT_NEAR(warm.normal_N, cold.contact.normal_N, 1e-9);
}

TEST(CircleContactTest, ASoftFingerBendsFar) {
  Finger soft = PaperFinger();
  soft.front_stiffness_N_mm2 = 4400;
  soft.back_stiffness_N_mm2 = 4250;
  EquilibriumSolver solver(soft, {});
  const Solved solved = Press(&solver, 10, 66.5, 20);
  ASSERT_EQ(solved.status, CircleContactStatus::kContact);
  EXPECT_LT(solver.tip_pose().x(), -5);
}

}  // namespace
}  // namespace finray
