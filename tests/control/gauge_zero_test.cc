#include <gtest/gtest.h>

#include "finray/control/control_loop.h"
#include "finray/statics/equilibrium.h"
#include "test_finger.h"

namespace finray {
namespace {

Measurements Readings(const Finger& finger,
                      const std::vector<PointContact>& contacts) {
  EquilibriumSolver solver(finger, {});
  EXPECT_TRUE(solver.Solve(contacts));
  Measurements readings;
  for (int j = 0; j < static_cast<int>(finger.gauges.size()); ++j) {
    readings.gauges_V.push_back(finger.gauges[j].Volts(solver.gauge_angle(j)));
  }
  return readings;
}

// The finger is bent by its ribs and has offsets that the model does not know.
TEST(GaugeZeroTest, TakesUnknownOffsetsOff) {
  Finger model = PaperFinger();
  model.ribs[2].length_mm += 0.3;
  model.gauges[1].offset_V = 0.2;
  Finger truth = model;
  truth.gauges[0].offset_V += 0.01;
  truth.gauges[3].offset_V -= 0.02;
  GaugeZero zero(model, {});
  Measurements loaded = Readings(truth, {{80, 4}});
  zero.Apply(&loaded);
  EXPECT_EQ(loaded.gauges_V, Readings(truth, {{80, 4}}).gauges_V);
  // Two noisy readings of the free finger, whose mean is right.
  Measurements free = Readings(truth, {});
  for (const double noise : {0.001, -0.001}) {
    Measurements noisy = free;
    for (double& volts : noisy.gauges_V) volts += noise;
    zero.Add(noisy);
  }
  zero.Apply(&loaded);
  const Measurements expected = Readings(model, {{80, 4}});
  for (int j = 0; j < 4; ++j) {
    EXPECT_NEAR(loaded.gauges_V[j], expected.gauges_V[j], 1e-12) << j;
  }
}

}  // namespace
}  // namespace finray
