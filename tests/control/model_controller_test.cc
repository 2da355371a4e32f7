#include "finray/control/model_controller.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "finray/control/plant.h"
#include "finray/objects/object_contact.h"
#include "test_finger.h"

namespace finray {
namespace {

constexpr ActuatorSettings kActuation = {1.0 / 30, 0.13, 0.03, 50};
const RigidObject kCircle{Outline(CircleOutline{15}), {}};

// The loop without estimator and noise: the controller sees the true contacts.
class ModelControllerTest : public testing::Test {
 protected:
  static std::vector<PushModel> Models(int fingers) {
    std::vector<PushModel> models;
    for (int i = 0; i < fingers; ++i) {
      models.emplace_back(PaperFinger(), 15, 0, Discretization());
    }
    return models;
  }

  // The forces at each period, starting in contact.
  static std::vector<double> Run(ModelController* controller, Plant* plant,
                                 Actuator* drive, const Trajectory& set_point,
                                 int periods, double speed_mm_s = 0) {
    std::vector<double> forces;
    for (int k = 0; k < periods; ++k) {
      const double time = k * kActuation.period_s;
      const PlantState state =
          plant->At(drive->AdvanceTo(time), speed_mm_s * time);
      EXPECT_EQ(state.failure, "");
      forces.push_back(state.force_N);
      std::vector<ContactEstimate> seen;
      for (const PlantFinger& finger : state.fingers) {
        EXPECT_EQ(finger.contacts.size(), 1u);
        seen.push_back(
            {finger.contacts[0].arc_mm, 0, finger.contacts[0].normal_N, 0.02});
      }
      drive->Command(time, controller->Next(time, seen, set_point, *drive));
    }
    return forces;
  }
};

// The force follows a step as soon as delay and drive allow, without overshoot:
// 2 N are 2.3 mm, which take 46 ms at 50 mm/s and some time constants.
TEST_F(ModelControllerTest, StepIsFollowedAtOnce) {
  ModelController controller(Models(1), Mechanism(), {10, 0, 0},
                             kActuation.period_s, false);
  Plant plant({PaperFinger()}, Mechanism(), kCircle, 0, {80, 0, -4});
  Actuator drive(kActuation, 0);
  const Trajectory set_point{{4, 6}, 1};
  const std::vector<double> forces =
      Run(&controller, &plant, &drive, set_point, 60);
  EXPECT_NEAR(forces[30], 4, 1e-3);
  EXPECT_NEAR(forces[33], 4, 1e-3);
  EXPECT_NEAR(forces[40], 6, 0.02);
  EXPECT_LT(*std::max_element(forces.begin(), forces.end()), 6.02);
}

// Near the tip the finger is more than twice as stiff; nothing needs tuning.
TEST_F(ModelControllerTest, StiffPartsAreNoMatter) {
  ModelController controller(Models(1), Mechanism(), {10, 0, 0},
                             kActuation.period_s, false);
  Plant plant({PaperFinger()}, Mechanism(), kCircle, 0, {110, 0, -2});
  Actuator drive(kActuation, 0);
  const std::vector<double> forces =
      Run(&controller, &plant, &drive, Trajectory{{4, 6, 4}, 1}, 90);
  EXPECT_NEAR(forces[55], 6, 0.01);
  EXPECT_NEAR(forces[85], 4, 0.01);
  EXPECT_LT(*std::max_element(forces.begin() + 30, forces.end()), 6.02);
}

// With a preview the force follows a harmonic set-point without lag.
TEST_F(ModelControllerTest, PreviewTakesTheLag) {
  double errors[2];
  for (const bool preview : {false, true}) {
    ModelController controller(Models(1), Mechanism(), {10, 0, 0},
                               kActuation.period_s, preview);
    Plant plant({PaperFinger()}, Mechanism(), kCircle, 0, {80, 0, -4});
    Actuator drive(kActuation, 0);
    const Trajectory set_point = Trajectory::Wave(4, 2, 3);
    const std::vector<double> forces =
        Run(&controller, &plant, &drive, set_point, 180);
    double squares = 0;
    for (int k = 90; k < 180; ++k) {
      squares += std::pow(forces[k] - set_point.At(k * kActuation.period_s), 2);
    }
    errors[preview] = std::sqrt(squares / 90);
  }
  // 163 ms of 2 N sin(2 pi t / 3 s): 0.48 N rms.
  EXPECT_NEAR(errors[false], 0.48, 0.02);
  EXPECT_LT(errors[true], 0.01);
}

// An object at constant speed leaves no steady error.
TEST_F(ModelControllerTest, FollowsAMovingObject) {
  ModelController controller(Models(1), Mechanism(), {10, 0, 0},
                             kActuation.period_s, false);
  Plant plant({PaperFinger()}, Mechanism(), kCircle, 0, {80, 0, -4});
  Actuator drive(kActuation, 0);
  const std::vector<double> forces =
      Run(&controller, &plant, &drive, Trajectory{{6}}, 120, 3);
  EXPECT_NEAR(forces[119], 6, 0.005);
  EXPECT_NEAR(controller.filter().velocity_mm_s(), 3, 0.02);
}

// The first step teaches the controller a spring of 0.5 N/mm.
TEST_F(ModelControllerTest, LearnsASpring) {
  const RigidObject sprung{Outline(CircleOutline{15}), ObjectSpring{0.5, M_PI}};
  ModelController controller(Models(1), Mechanism(), {10, 0.5, 0.01},
                             kActuation.period_s, false);
  Plant plant({PaperFinger()}, Mechanism(), sprung, 0, {80, 0, -6});
  Actuator drive(kActuation, 0);
  const std::vector<double> forces =
      Run(&controller, &plant, &drive, Trajectory{{3, 5, 3, 5}, 3}, 360);
  EXPECT_NEAR(controller.filter().compliance_mm_per_N(), 2, 0.1);
  EXPECT_NEAR(forces[359], 5, 0.02);
  EXPECT_LT(*std::max_element(forces.begin() + 270, forces.end()), 5.1);
}

TEST_F(ModelControllerTest, TwoUnlikeFingers) {
  const Mechanism gripper(FourBar{{10, -75}, {10, -15}, {50, -75}, {50, -15}});
  ModelController controller(Models(2), gripper, {10, 0, 0},
                             kActuation.period_s, false);
  Finger soft = PaperFinger();
  soft.front_stiffness_N_mm2 *= 0.98;
  soft.back_stiffness_N_mm2 *= 0.98;
  Plant plant({PaperFinger(), soft}, gripper, kCircle, 0, {80, 0, -4});
  ActuatorSettings motor = kActuation;
  motor.speed_limit = 0.8;
  Actuator drive(motor, 0);
  const std::vector<double> forces =
      Run(&controller, &plant, &drive, Trajectory{{4, 10}, 1}, 75);
  EXPECT_NEAR(forces[29], 4, 0.05);
  EXPECT_NEAR(forces[74], 10, 0.05);
}

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

constexpr double kPeriod_s = 1.0 / 30;

TEST(ObjectFilterTest, FollowsAConstantSpeed) {
  ObjectFilter filter({10, 0, 0}, kPeriod_s);
  for (int k = 0; k < 120; ++k) {
    filter.Predict();
    filter.Update(5 + 3 * k * kPeriod_s, 6, 0.05);
  }
  EXPECT_NEAR(filter.velocity_mm_s(), 3, 1e-4);
  EXPECT_NEAR(filter.PlaceIn(0.2), 5 + 3 * (119 * kPeriod_s + 0.2), 1e-4);
  EXPECT_EQ(filter.compliance_mm_per_N(), 0);
}

// A varying force separates o and c in z = o - c F.
TEST(ObjectFilterTest, LearnsTheCompliance) {
  ObjectFilter filter({10, 0.5, 0}, kPeriod_s);
  std::mt19937_64 generator(1);
  std::normal_distribution<double> noise(0, 0.05);
  for (int k = 0; k < 600; ++k) {
    const double force = 4 + 2 * std::sin(2 * M_PI * k * kPeriod_s / 3);
    filter.Predict();
    filter.Update(-20 - 1.25 * force + noise(generator), force, 0.05);
  }
  EXPECT_NEAR(filter.compliance_mm_per_N(), 1.25, 0.05);
  EXPECT_NEAR(filter.PlaceIn(0), -20, 0.2);
}

TEST(ObjectFilterTest, ComplianceIsNotNegative) {
  ObjectFilter filter({10, 0.5, 0}, kPeriod_s);
  for (int k = 0; k < 100; ++k) {
    const double force = 4 + 2 * std::sin(0.3 * k);
    filter.Predict();
    filter.Update(0.2 * force, force, 0.05);
    EXPECT_GE(filter.compliance_mm_per_N(), 0);
  }
}

// The errors of the place agree with the covariance, over 200 motions with the
// acceleration of the prior.
TEST(ObjectFilterTest, CovarianceIsHonest) {
  std::mt19937_64 generator(2);
  std::normal_distribution<double> unit;
  double sum = 0;
  constexpr int kMotions = 200;
  for (int motion = 0; motion < kMotions; ++motion) {
    ObjectFilter filter({10, 0, 0}, kPeriod_s);
    double place = 0, velocity = 3 * unit(generator);
    for (int k = 0; k < 60; ++k) {
      if (k > 0) {
        const double a = 10 * unit(generator);
        place += velocity * kPeriod_s + 0.5 * a * kPeriod_s * kPeriod_s;
        velocity += a * kPeriod_s;
      }
      filter.Predict();
      filter.Update(place + 0.1 * unit(generator), 6, 0.1);
    }
    const double error = filter.PlaceIn(0) - place;
    sum += error * error / filter.covariance()(0, 0);
  }
  // chi2 with 200 degrees of freedom, over 200, has the std 0.1.
  EXPECT_NEAR(sum / kMotions, 1, 0.3);
}

TEST(ObjectFilterTest, RestartKeepsTheCompliance) {
  ObjectFilter filter({10, 0.5, 0}, kPeriod_s);
  for (int k = 0; k < 300; ++k) {
    const double force = 4 + 2 * std::sin(0.3 * k);
    filter.Predict();
    filter.Update(-force, force, 0.02);
  }
  const double compliance = filter.compliance_mm_per_N();
  filter.Restart();
  EXPECT_FALSE(filter.started());
  filter.Update(7, 2, 0.02);
  EXPECT_EQ(filter.compliance_mm_per_N(), compliance);
  EXPECT_NEAR(filter.PlaceIn(0), 7 + 2 * compliance, 1e-12);
  EXPECT_EQ(filter.velocity_mm_s(), 0);
}

}  // namespace
}  // namespace finray
