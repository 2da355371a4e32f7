#include "finray/control/controller.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace finray {
namespace {

TEST(TrajectoryTest, HarmonicAndTriangular) {
  const Trajectory harmonic = Trajectory::Wave(4, 2, 3);
  EXPECT_DOUBLE_EQ(harmonic.At(0.75), 6);
  EXPECT_NEAR(harmonic.At(0.25), 5, 1e-12);
  const Trajectory triangular = Trajectory::Wave(4, 2, 4, true);
  EXPECT_NEAR(triangular.At(0.25), 4.5, 1e-12);
  EXPECT_NEAR(triangular.At(1.5), 5, 1e-12);
  EXPECT_NEAR(triangular.At(3), 2, 1e-12);
  EXPECT_DOUBLE_EQ(triangular.Middle(), 4);
}

TEST(TrajectoryTest, StepsJumpAtTheirTime) {
  const Trajectory steps{{4, 6, 10}, 1};
  EXPECT_DOUBLE_EQ(steps.At(-1), 4);
  EXPECT_DOUBLE_EQ(steps.At(0.999), 4);
  // 30 periods of 1 / 30 s are a second, apart from rounding.
  double second = 0;
  for (int i = 0; i < 30; ++i) second += 1.0 / 30;
  EXPECT_DOUBLE_EQ(steps.At(second), 6);
  EXPECT_DOUBLE_EQ(steps.At(99), 10);
  EXPECT_DOUBLE_EQ(steps.Middle(), 7);
  EXPECT_TRUE(std::isinf(steps.SinceStep(0.5)));
  EXPECT_NEAR(steps.SinceStep(2.25), 0.25, 1e-12);
}

TEST(TrajectoryTest, RampsLeadFromLevelToLevel) {
  const Trajectory steps{{4, 6}, 1, 0.5};
  EXPECT_DOUBLE_EQ(steps.At(1), 4);
  EXPECT_DOUBLE_EQ(steps.At(1.25), 5);
  EXPECT_DOUBLE_EQ(steps.At(1.5), 6);
}

// The rule by hand: theta = 130 + 20 / 2 = 140 ms, k = 0.9 N/mm.
TEST(PiControllerTest, GainsFollowTheRule) {
  const PiController slow(0.9, {0.02, 0.13, 0.03, 50}, false);
  EXPECT_NEAR(slow.proportional_gain(), 0.03 / (0.9 * 0.28), 1e-12);
  EXPECT_NEAR(slow.integral_gain_per_s(), 1 / (0.9 * 0.28), 1e-12);
  // A servo slower than eight dead times.
  const PiController lazy(0.9, {0.02, 0.01, 0.4, 50}, false);
  EXPECT_NEAR(lazy.proportional_gain(), 0.4 / (0.9 * 0.04), 1e-12);
  EXPECT_NEAR(lazy.integral_gain_per_s(), 0.4 / (0.9 * 0.04) / 0.16, 1e-12);
}

// On the plant for which it is tuned the PI settles without a steady error and
// overshoots by about the 4 % of the rule.
TEST(PiControllerTest, SettlesOnALinearPlant) {
  const ActuatorSettings settings = {1.0 / 30, 0.13, 0.03, 50};
  PiController controller(0.9, settings, false);
  Actuator drive(settings, 0);
  const Trajectory set_point{{3}};
  double highest = 0, force = 0;
  for (int k = 0; k < 150; ++k) {
    const double time = k * settings.period_s;
    force = 0.9 * drive.AdvanceTo(time);
    highest = std::max(highest, force);
    drive.Command(
        time, controller.Next(time, {{80, 0, force, 0.1}}, set_point, drive));
  }
  EXPECT_NEAR(force, 3, 1e-4);
  EXPECT_LT(highest, 3 * 1.08);
}

// The command does not run away from a drive at its speed limit.
TEST(PiControllerTest, DoesNotWindUp) {
  const ActuatorSettings settings = {1.0 / 30, 0.13, 0.03, 2};
  PiController controller(0.9, settings, false);
  Actuator drive(settings, 0);
  const Trajectory set_point{{50}};
  for (int k = 0; k < 100; ++k) {
    const double time = k * settings.period_s;
    drive.AdvanceTo(time);
    const double command =
        controller.Next(time, {{80, 0, 0, 0.1}}, set_point, drive);
    EXPECT_LT(command - drive.PredictAt(time), 2 * (0.13 + 0.034 + 0.03));
    drive.Command(time, command);
  }
}

}  // namespace
}  // namespace finray
