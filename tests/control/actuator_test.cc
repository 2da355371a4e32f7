#include <gtest/gtest.h>

#include <cmath>

#include "finray/control/drive.h"

namespace finray {
namespace {

constexpr ActuatorSettings kSettings = {0.05, 0.13, 0.03, 50};

TEST(ActuatorTest, MovesAfterTheDelay) {
  Actuator drive(kSettings, 1);
  drive.Command(0, 2);
  EXPECT_DOUBLE_EQ(drive.AdvanceTo(0.1299), 1);
  // A way of 1 mm is below 50 mm/s * 30 ms: an exponential from the start.
  EXPECT_NEAR(drive.AdvanceTo(0.16), 2 - std::exp(-1), 1e-12);
}

TEST(ActuatorTest, IsLimitedInSpeed) {
  Actuator drive(kSettings, 0);
  drive.Command(0, 11.5);
  // 10 mm at 50 mm/s, then 1.5 mm exponentially.
  EXPECT_NEAR(drive.AdvanceTo(0.13 + 0.1), 5, 1e-12);
  EXPECT_NEAR(drive.AdvanceTo(0.13 + 0.2 + 0.03), 11.5 - 1.5 * std::exp(-1),
              1e-12);
}

// The motion does not depend on the times at which it is read.
TEST(ActuatorTest, IsIntegratedExactly) {
  Actuator coarse(kSettings, 0), fine(kSettings, 0);
  for (int k = 0; k < 20; ++k) {
    const double position = 8 * std::sin(0.7 * k);
    coarse.Command(0.05 * k, position);
    fine.Command(0.05 * k, position);
    for (int i = 1; i <= 10; ++i) fine.AdvanceTo(0.05 * k + 0.005 * i);
  }
  EXPECT_NEAR(coarse.AdvanceTo(1.0), fine.AdvanceTo(1.0), 1e-12);
}

TEST(ActuatorTest, PredictionLooksAheadOnly) {
  Actuator drive(kSettings, 0);
  drive.Command(0, 1);
  const double later = drive.PredictAt(0.2);
  EXPECT_GT(later, 0.5);
  EXPECT_DOUBLE_EQ(drive.AdvanceTo(0.1), 0);
  EXPECT_NEAR(drive.AdvanceTo(0.2), later, 1e-12);
}

// The command is right although others are still in flight.
TEST(ActuatorTest, CommandForArrivesInTime) {
  Actuator drive(kSettings, 0);
  drive.Command(0, 0.5);
  drive.Command(0.05, -0.2);
  drive.AdvanceTo(0.1);
  drive.Command(0.1, drive.CommandFor(0.1, 0.7));
  EXPECT_NEAR(drive.AdvanceTo(0.1 + 0.13 + 0.05), 0.7, 1e-12);
}

TEST(ActuatorTest, MeasuredPositionReplacesItsOwn) {
  Actuator drive(kSettings, 0);
  drive.AdvanceTo(1);
  drive.CorrectTo(1);
  EXPECT_DOUBLE_EQ(drive.PredictAt(1), 1);
  // The command in force moves it back.
  EXPECT_NEAR(drive.AdvanceTo(1.03), std::exp(-1), 1e-12);
}

}  // namespace
}  // namespace finray
