#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "finray/control/controller.h"

namespace finray {
namespace {

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
