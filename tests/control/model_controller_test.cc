#include "finray/control/model_controller.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "finray/control/plant.h"
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
  Plant plant({PaperFinger()}, Mechanism(), kCircle, 0, 80, 0, -4);
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
  Plant plant({PaperFinger()}, Mechanism(), kCircle, 0, 110, 0, -2);
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
    Plant plant({PaperFinger()}, Mechanism(), kCircle, 0, 80, 0, -4);
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
  Plant plant({PaperFinger()}, Mechanism(), kCircle, 0, 80, 0, -4);
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
  Plant plant({PaperFinger()}, Mechanism(), sprung, 0, 80, 0, -6);
  Actuator drive(kActuation, 0);
  const std::vector<double> forces =
      Run(&controller, &plant, &drive, Trajectory{{3, 5, 3, 5}, 3}, 360);
  EXPECT_NEAR(controller.filter().compliance_mm_per_N(), 2, 0.1);
  EXPECT_NEAR(forces[359], 5, 0.02);
  EXPECT_LT(*std::max_element(forces.begin() + 270, forces.end()), 5.1);
}

TEST_F(ModelControllerTest, TwoUnlikeFingers) {
  const Mechanism gripper(
      FourBar(FourBarJoints{{10, -75}, {10, -15}, {50, -75}, {50, -15}}));
  ModelController controller(Models(2), gripper, {10, 0, 0},
                             kActuation.period_s, false);
  Finger soft = PaperFinger();
  soft.front_stiffness_N_mm2 *= 0.98;
  soft.back_stiffness_N_mm2 *= 0.98;
  Plant plant({PaperFinger(), soft}, gripper, kCircle, 0, 80, 0, -4);
  ActuatorSettings motor = kActuation;
  motor.speed_limit = 0.8;
  Actuator drive(motor, 0);
  const std::vector<double> forces =
      Run(&controller, &plant, &drive, Trajectory{{4, 10}, 1}, 75);
  EXPECT_NEAR(forces[29], 4, 0.05);
  EXPECT_NEAR(forces[74], 10, 0.05);
}

}  // namespace
}  // namespace finray
