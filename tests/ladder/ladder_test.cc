#include "finray/ladder/ladder.h"

#include <gtest/gtest.h>

#include <cmath>

#include "finray/ladder/ladder_workspace.h"
#include "test_finger.h"

namespace finray {
namespace {

TEST(LadderWorkspaceTest, GaugeEndsAreSortedWithTheirSigns) {
  Finger finger = PaperFinger();
  finger.gauges[1].beam = Side::kFront;
  finger.gauges[2].start_mm = 140 / std::sin(112 * M_PI / 180) - 18 - 1e-9;
  const LadderModel model(finger, {});
  const LadderWorkspace<double> workspace(model);
  const LadderFrame<double>& f = workspace.frame();
  ASSERT_EQ(f.readout_count, 8);
  int on_front = 0, signs = 0, element = 0;
  double offset = 0;
  for (int i = 0; i < f.readout_count; ++i) {
    const LadderReadout<double>& end = f.readouts[i];
    const bool front = end.element < f.front_elements;
    const Side side = front ? Side::kFront : Side::kBack;
    const int k = end.element - (front ? 0 : f.front_elements);
    const double arc =
        model.mesh(side).nodes_mm[k] + end.offset * workspace.length_unit();
    const Gauge& gauge = finger.gauges[end.gauge];
    EXPECT_EQ(gauge.beam, side);
    EXPECT_NEAR(arc, gauge.start_mm + (end.sign > 0 ? gauge.length_mm : 0),
                1e-9);
    EXPECT_TRUE(end.element > element ||
                (end.element == element && end.offset >= offset));
    element = end.element;
    offset = end.offset;
    on_front += front;
    signs += end.sign;
  }
  EXPECT_EQ(on_front, 2);
  EXPECT_EQ(signs, 0);
}

}  // namespace
}  // namespace finray
