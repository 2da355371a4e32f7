// What a model keeps of its finger, beyond the mesh.

#include "finray/ladder/ladder.h"

#include <gtest/gtest.h>

#include <cmath>

#include "test_finger.h"

namespace finray {
namespace {

TEST(LadderModelTest, GaugeEndsAreSortedWithTheirSigns) {
  Finger finger = PaperFinger();
  finger.gauges[1].beam = Side::kFront;
  finger.gauges[2].start_mm = 140 / std::sin(112 * M_PI / 180) - 18 - 1e-9;
  const LadderModel model(finger, {});
  ASSERT_EQ(model.gauge_ends(Side::kFront).size(), 2u);
  ASSERT_EQ(model.gauge_ends(Side::kBack).size(), 6u);
  for (const Side side : {Side::kFront, Side::kBack}) {
    double before = -1;
    for (const LadderModel::GaugeEnd& end : model.gauge_ends(side)) {
      const double arc =
          model.mesh(side).nodes_mm[end.point.element] + end.point.offset_mm;
      const Gauge& gauge = finger.gauges[end.gauge];
      EXPECT_EQ(gauge.beam, side);
      EXPECT_GE(arc, before);
      EXPECT_NEAR(arc, gauge.start_mm + (end.sign > 0 ? gauge.length_mm : 0),
                  1e-9);
      before = arc;
    }
  }
}

}  // namespace
}  // namespace finray
