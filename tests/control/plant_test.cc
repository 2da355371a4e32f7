#include "finray/control/plant.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <stdexcept>

#include "finray/control/model_controller.h"
#include "test_finger.h"

namespace finray {
namespace {

using Eigen::Vector2d;

const RigidObject kPlantCircle{Outline(CircleOutline{15}), {}};

Mechanism Gripper() {
  return Mechanism(FourBar{{10, -75}, {10, -15}, {50, -75}, {50, -15}});
}

// The stage touches after the gap. From there on the force is that of
// PushModel.
TEST(PlantTest, StageAgainstAFixedObject) {
  const Finger finger = PaperFinger();
  Plant plant({finger}, Mechanism(), kPlantCircle, 0, {80, 0, 2});
  EXPECT_EQ(plant.At(1.99, 0).force_N, 0);
  EXPECT_GT(plant.At(2.01, 0).force_N, 0);
  PushModel model(finger, 15, 0, {});
  for (const double force : {1.0, 5.0, 2.0}) {
    const auto push =
        model.At(MakePose<double>(0, Vector2d::Zero()), 80, force, 80);
    ASSERT_TRUE(push);
    const double depth = push->object_x_mm + 15;
    EXPECT_NEAR(plant.At(2 + depth, 0).force_N, force, 1e-6);
    // The object may move by as much instead of the stage.
    EXPECT_NEAR(plant.At(0, 2 + depth).force_N, force, 1e-6);
  }
}

// An object on a spring yields by u with F = k u, so the finger bends less.
TEST(PlantTest, ObjectOnASpring) {
  const Finger finger = PaperFinger();
  const RigidObject sprung{Outline(CircleOutline{15}), ObjectSpring{0.5, M_PI}};
  Plant plant({finger}, Mechanism(), sprung, 0, {80, 0, 0});
  const PlantState state = plant.At(9, 0);
  ASSERT_EQ(state.failure, "");
  const PlantFinger& touched = state.fingers[0];
  EXPECT_NEAR(touched.force_N.x(), 0.5 * touched.displacement_mm, 1e-6);
  Plant fixed({finger}, Mechanism(), kPlantCircle, 0, {80, 0, 0});
  EXPECT_NEAR(fixed.At(9 - touched.displacement_mm, 0).force_N, state.force_N,
              1e-6);
}

// Different fingers shift the object until their forces along x are equal.
TEST(PlantTest, TwoFingersBalance) {
  const Finger finger = PaperFinger();
  std::mt19937_64 generator(3);
  const ModelError error{5, 0, 0, 0.05};
  Plant plant({Perturbed(finger, error, &generator),
               Perturbed(finger, error, &generator)},
              Gripper(), kPlantCircle, 0, {80, 0, 1});
  EXPECT_EQ(plant.At(0, 0).force_N, 0);
  for (const double motor : {0.05, 0.12, 0.2, 0.08}) {
    const PlantState state = plant.At(motor, 0);
    ASSERT_EQ(state.failure, "");
    EXPECT_GT(state.force_N, 0.5);
    EXPECT_NEAR(state.fingers[0].force_N.x(), state.fingers[1].force_N.x(),
                1e-6);
    // The sum of both gaps does not depend on the shift of the object.
    const double sum = state.fingers[0].object.position_mm.x() +
                       state.fingers[1].object.position_mm.x();
    EXPECT_NEAR(sum, 2 * (-16 + 60 * std::sin(motor)), 1e-9);
  }
}

// Each of two equal fingers acts like one finger against a wall.
TEST(PlantTest, EqualFingersDoNotShiftTheObject) {
  const Finger finger = PaperFinger();
  Plant two({finger, finger}, Gripper(), kPlantCircle, 0, {80, 0, 1});
  const PlantState state = two.At(0.1, 0);
  EXPECT_NEAR(state.fingers[0].object.position_mm.x(),
              state.fingers[1].object.position_mm.x(), 1e-6);
  EquilibriumSolver solver(finger, {});
  const ObjectContact found =
      SolveObjectContact(kPlantCircle, state.fingers[0].object, 0, &solver);
  ASSERT_EQ(found.contacts.size(), 1u);
  EXPECT_NEAR(found.contacts[0].normal_N, state.force_N, 1e-5);
}

TEST(PlantTest, SaysWhyThereIsNoEquilibrium) {
  Plant plant({PaperFinger()}, Mechanism(), kPlantCircle, 0, {139, 0, 1});
  EXPECT_EQ(plant.At(6, 0).failure,
            "the object meets an end of the front beam, not its side");
}

TEST(PlantTest, RefusesASpringBetweenTwoFingers) {
  const RigidObject sprung{Outline(CircleOutline{15}), ObjectSpring{1, 0}};
  const Finger finger = PaperFinger();
  EXPECT_THROW(Plant({finger, finger}, Gripper(), sprung, 0, {80, 0, 1}),
               std::invalid_argument);
}

// Each parameter has the given spread; nothing else changes.
TEST(ModelErrorTest, SpreadsAsItSays) {
  const Finger finger = PaperFinger();
  std::mt19937_64 generator(1);
  double stiffness = 0, gain = 0, offset = 0, rib = 0;
  constexpr int kDraws = 2000;
  for (int i = 0; i < kDraws; ++i) {
    const Finger other = Perturbed(finger, {1, 0.3, 5e-4, 0.03}, &generator);
    stiffness += std::pow(other.front_stiffness_N_mm2 / 12500 - 1, 2);
    gain += std::pow(other.gauges[2].gain_V_per_rad - 1, 2);
    offset += std::pow(other.gauges[0].offset_V, 2);
    rib += std::pow(other.ribs[4].length_mm - finger.ribs[4].length_mm, 2);
    EXPECT_EQ(other.gauges[1].noise_V, finger.gauges[1].noise_V);
    EXPECT_EQ(other.ribs[0].front_mm, finger.ribs[0].front_mm);
  }
  // The std of a std from 2000 draws is 1.6 %; this is three times that.
  EXPECT_NEAR(std::sqrt(stiffness / kDraws), 0.01, 0.0005);
  EXPECT_NEAR(std::sqrt(gain / kDraws), 0.003, 0.00015);
  EXPECT_NEAR(std::sqrt(offset / kDraws), 5e-4, 2.5e-5);
  EXPECT_NEAR(std::sqrt(rib / kDraws), 0.03, 0.0015);
}

}  // namespace
}  // namespace finray
