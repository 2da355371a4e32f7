#include "finray/objects/sliding_friction.h"

#include <gtest/gtest.h>

#include <cmath>

#include "finray/finger/finger_yaml.h"
#include "finray/io/frame_table.h"
#include "objects/object_checks.h"
#include "test_finger.h"

namespace finray {
namespace {

constexpr double kRadius = 15;

// Where a circle without friction touches: l_c - R theta, whose change is its
// slip.
double Rolled(const Eigen::Vector2d& centre_mm) {
  EquilibriumSolver solver(PaperFinger(), {});
  const ObjectContact found =
      SolveObjectContact(Circle(kRadius), {centre_mm}, 0, &solver);
  EXPECT_EQ(found.contacts.size(), 1u);
  return found.contacts[0].arc_mm - kRadius * solver.contact_pose(0).z();
}

// Without friction the finger does not answer, and the law is that of the slip
// alone.
TEST(SlidingFrictionTest, FollowsDahlsLaw) {
  constexpr double kPresliding = 0.2;
  EquilibriumSolver solver(PaperFinger(), {});
  SlidingFriction sliding(Circle(kRadius), 0, kPresliding, 0);
  const Eigen::Vector2d path[] = {{-13, 50},   {-13, 50.1}, {-12.5, 50.4},
                                  {-13, 49.9}, {-13, 48},   {-14, 48}};
  double state = 0, last = 50 - kRadius * M_PI / 2;
  for (const Eigen::Vector2d& centre : path) {
    const double at = Rolled(centre), slip = at - last;
    last = at;
    // The law as a differential equation, in small steps.
    constexpr int kSteps = 100000;
    for (int i = 0; i < kSteps; ++i) {
      state +=
          ((slip > 0 ? 1 : -1) - state) * std::abs(slip) / kSteps / kPresliding;
    }
    const auto friction = sliding.Next({centre}, &solver);
    ASSERT_TRUE(friction.has_value());
    EXPECT_EQ(*friction, 0);
    EXPECT_NEAR(sliding.state(), state, 1e-4) << centre.transpose();
  }
}

// A rough object takes the beam along until the limit is reached, and the
// finger gives way by as much as it must.
TEST(SlidingFrictionTest, SticksBeforeItSlides) {
  constexpr double kFriction = 0.8, kPresliding = 1e-3;
  EquilibriumSolver solver(PaperFinger(), {});
  SlidingFriction sliding(Circle(kRadius), kFriction, kPresliding, 0);
  ASSERT_TRUE(sliding.Next({{-12, 60}}, &solver).has_value());
  const double pressed = sliding.state();
  double least = 1;
  for (int i = 1; i <= 40; ++i) {
    const auto friction = sliding.Next({{-12, 60 - 0.01 * i}}, &solver);
    ASSERT_TRUE(friction.has_value());
    // The contact is the equilibrium at that friction.
    EXPECT_EQ(sliding.contact().contacts[0].friction, *friction);
    ExpectContact(Circle(kRadius), {{-12, 60 - 0.01 * i}}, sliding.contact(),
                  solver);
    EXPECT_LE(sliding.state(), least + 1e-6);
    least = sliding.state();
  }
  EXPECT_GT(pressed, 0.9);
  EXPECT_LT(least, -0.99);
}

TEST(SlidingFrictionTest, ATouchEndsWhereTheObjectWasLifted) {
  EquilibriumSolver solver(PaperFinger(), {});
  const auto pressed = [&](const Eigen::Vector2d& centre) {
    SlidingFriction alone(Circle(kRadius), 0.3, 1e-3, 0);
    return alone.Next({centre}, &solver).value();
  };
  SlidingFriction sliding(Circle(kRadius), 0.3, 1e-3, 0);
  ASSERT_NEAR(sliding.Next({{-13, 60}}, &solver).value(), 0.3, 1e-3);
  EXPECT_NEAR(sliding.Next({{-13, 58}}, &solver).value(), -0.3, 1e-6);
  // 10 mm on: another touch. Without contact or place: none.
  EXPECT_NEAR(sliding.Next({{-13, 48}}, &solver).value(), pressed({-13, 48}),
              1e-6);
  EXPECT_NEAR(sliding.Next({{-13, 46}}, &solver).value(), -0.3, 1e-6);
  EXPECT_FALSE(sliding.Next({{-25, 46}}, &solver).has_value());
  EXPECT_NEAR(sliding.Next({{-13, 46}}, &solver).value(), pressed({-13, 46}),
              1e-6);
  EXPECT_FALSE(sliding.Next({{NAN, 46}}, &solver).has_value());
}

// What a stage's noise pretends is no motion.
TEST(SlidingFrictionTest, NoiseDoesNotMoveIt) {
  EquilibriumSolver solver(PaperFinger(), {});
  SlidingFriction sliding(Circle(kRadius), 0.3, 1e-3, 0.05);
  const double pressed = sliding.Next({{-13, 60}}, &solver).value();
  for (const double off : {0.1, -0.12, 0.15, -0.2}) {
    EXPECT_EQ(sliding.Next({{-13 + off / 2, 60 + off}}, &solver), pressed);
  }
  EXPECT_LT(sliding.Next({{-13, 59.7}}, &solver).value(), -0.29);
}

// CalculiX's tangential over normal force in two logs, where a circle of rough
// solids is pressed in, drawn half back, and slid along a strip finger. There
// the contact gives by p mu / 500 N/mm^3 before it slides, with a pressure p of
// about 0.25 N/mm^2.
TEST(SlidingFrictionTest, AgreesWithCalculix) {
  const std::string strip = FINRAY_SOURCE_DIR "/datasets/reality/strip/";
  Finger finger = ReadFinger(strip + "finger.yaml");
  finger.front_stiffness_N_mm2 = 11409.1;  // plant.yaml
  finger.back_stiffness_N_mm2 = 14577;
  finger.front_surface_mm = 0.235;
  EquilibriumSolver solver(finger, {});
  int rows = 0, near = 0, backward = 0;
  for (const char* name : {"train", "holdout"}) {
    const FrameTable truth =
        FrameTable::Read(strip + "rough/" + name + "_truth.csv");
    SlidingFriction sliding(Circle(kRadius), 0.3, 1.5e-4, 0);
    for (std::size_t row = 0; row < truth.rows(); ++row) {
      const double friction = truth.Numbers("friction_1")[row];
      const auto found = sliding.Next({{truth.Numbers("object_x_mm")[row],
                                        truth.Numbers("object_y_mm")[row]}},
                                      &solver);
      ASSERT_EQ(found.has_value(), std::isfinite(friction));
      if (!found) continue;
      ++rows;
      backward += friction < 0;
      near += std::abs(*found - friction) < 0.03;
    }
  }
  EXPECT_EQ(rows, 180);
  EXPECT_GT(backward, 40);
  EXPECT_GE(near, 175);
}

}  // namespace
}  // namespace finray
