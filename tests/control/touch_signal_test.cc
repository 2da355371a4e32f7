#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "finray/control/contact_watch.h"
#include "finray/statics/equilibrium.h"
#include "test_finger.h"

namespace finray {
namespace {

Measurements Readings(const Finger& finger, double arc_mm, double force_N) {
  EquilibriumSolver solver(finger, {});
  EXPECT_TRUE(solver.Solve({{arc_mm, force_N}}));
  Measurements readings;
  for (int j = 0; j < static_cast<int>(finger.gauges.size()); ++j) {
    readings.gauges_V.push_back(solver.gauge_angle(j));
  }
  return readings;
}

// A contact of touch_N between 0.2 and 0.8 of the length gives 1 or more.
TEST(TouchSignalTest, IsOneOrMoreForTheTouchItself) {
  const Finger finger = PaperFinger();
  const TouchSignal signal(finger, 1.5, {});
  double least = 1e9;
  for (double arc = 28; arc <= 112; arc += 3.5) {
    least = std::min(least, signal.Of(Readings(finger, arc, 1.5)));
  }
  EXPECT_NEAR(least, 1, 0.001);
  EXPECT_LT(signal.Of(Readings(finger, 80, 0.01)), 0.1);
}

TEST(TouchSignalTest, IsUnknownWithoutAGauge) {
  const Finger finger = PaperFinger();
  const TouchSignal signal(finger, 1.5, {});
  Measurements readings = Readings(finger, 80, 0.01);
  readings.gauges_V[2] = std::nan("");
  EXPECT_TRUE(std::isnan(signal.Of(readings)));
}

}  // namespace
}  // namespace finray
