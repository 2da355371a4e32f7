// How bays are divided, beyond mesh_test.cc.

#include <gtest/gtest.h>

#include <cmath>

#include "finray/io/error.h"
#include "finray/statics/ladder.h"
#include "finray/statics/mesh.h"
#include "test_finger.h"

namespace finray {
namespace {

// A bay of a whole number of elements must not gain one by rounding.
TEST(MeshDivisionTest, WholeNumbersOfElementsStayWhole) {
  Finger finger = PaperFinger();
  finger.ribs.clear();
  finger.back_angle_rad = 5 * M_PI / 6;  // sin = 1/2: the back is twice as long
  for (const int front : {1, 3, 7, 49, 333}) {
    const Discretization discretization{Scheme::kTaylor, 3 * front};
    EXPECT_EQ(MakeBeamMesh(finger, Side::kFront, discretization).elements(),
              front);
    EXPECT_EQ(MakeBeamMesh(finger, Side::kBack, discretization).elements(),
              2 * front);
  }
}

TEST(MeshDivisionTest, ElementsOfABayAreEqual) {
  const Finger finger = PaperFinger();
  for (const Side side : {Side::kFront, Side::kBack}) {
    const BeamMesh mesh = MakeBeamMesh(finger, side, {Scheme::kTaylor, 100});
    int from = 0;
    for (const int to : mesh.rib_node) {
      const double even =
          (mesh.nodes_mm[to] - mesh.nodes_mm[from]) / (to - from);
      for (int k = from; k < to; ++k) {
        EXPECT_NEAR(mesh.nodes_mm[k + 1] - mesh.nodes_mm[k], even, 1e-12);
      }
      from = to;
    }
  }
}

TEST(MeshDivisionTest, ZeroResolutionIsTheSchemesDefault) {
  const Finger finger = PaperFinger();
  const auto total = [&](const Discretization& discretization) {
    return MakeBeamMesh(finger, Side::kFront, discretization).elements() +
           MakeBeamMesh(finger, Side::kBack, discretization).elements();
  };
  EXPECT_EQ(total({Scheme::kTaylor, 0}), total({Scheme::kTaylor, 24}));
  EXPECT_EQ(total({Scheme::kRigidChain, 0}), total({Scheme::kRigidChain, 200}));
}

TEST(MeshDivisionTest, GaugeEndsAreSortedWithTheirSigns) {
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

TEST(MeshDivisionTest, ResolutionsOutOfRangeAreRefused) {
  EXPECT_THROW(ParseDiscretization("taylor", -1), InputError);
  EXPECT_THROW(ParseDiscretization("taylor", 1000001), InputError);
  EXPECT_EQ(ParseDiscretization("rigid_chain", 100000).resolution, 100000);
}

}  // namespace
}  // namespace finray
