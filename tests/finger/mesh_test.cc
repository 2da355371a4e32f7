#include "finray/finger/mesh.h"

#include <gtest/gtest.h>

#include "finray/finger/geometry.h"
#include "test_finger.h"

namespace finray {
namespace {

TEST(MeshTest, EveryRibIsANodeAndNoElementIsTooLong) {
  const Finger finger = PaperFinger();
  const double length =
      BeamLength(finger, Side::kFront) + BeamLength(finger, Side::kBack);
  for (const int resolution : {1, 24, 200}) {
    for (const Side side : {Side::kFront, Side::kBack}) {
      const BeamMesh mesh = MakeBeamMesh(finger, side, resolution);
      EXPECT_EQ(mesh.nodes_mm.front(), 0);
      EXPECT_EQ(mesh.nodes_mm.back(), BeamLength(finger, side));
      for (int i = 0; i < 5; ++i) {
        EXPECT_EQ(mesh.nodes_mm[mesh.rib_node[i]],
                  side == Side::kFront ? finger.ribs[i].front_mm
                                       : finger.ribs[i].back_mm);
      }
      for (int k = 0; k < mesh.elements(); ++k) {
        const double h = mesh.nodes_mm[k + 1] - mesh.nodes_mm[k];
        EXPECT_GT(h, 0);
        if (resolution > 6) {
          EXPECT_LE(h, length / resolution * (1 + 1e-9));
        }
      }
      if (resolution == 1) {
        EXPECT_EQ(mesh.elements(), 6);
      }
    }
  }
}

// A bay of a whole number of elements must not gain one by rounding.
TEST(MeshTest, WholeNumbersOfElementsStayWhole) {
  Finger finger = PaperFinger();
  finger.ribs.clear();
  finger.back_angle_rad = 5 * M_PI / 6;  // sin = 1/2: the back is twice as long
  for (const int front : {1, 3, 7, 49, 333}) {
    EXPECT_EQ(MakeBeamMesh(finger, Side::kFront, 3 * front).elements(), front);
    EXPECT_EQ(MakeBeamMesh(finger, Side::kBack, 3 * front).elements(),
              2 * front);
  }
}

TEST(MeshTest, ElementsOfABayAreEqual) {
  const Finger finger = PaperFinger();
  for (const Side side : {Side::kFront, Side::kBack}) {
    const BeamMesh mesh = MakeBeamMesh(finger, side, 100);
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

TEST(MeshTest, PiecesEndAtNodes) {
  Finger finger = PaperFinger();
  finger.front_pieces = {{17, 2.0}, {50, 0.5}, {140, 1.0}};
  const BeamMesh mesh = MakeBeamMesh(finger, Side::kFront, 24);
  EXPECT_EQ(mesh.nodes_mm[mesh.rib_node[4]], 105);
  ASSERT_EQ(mesh.stiffness_ratio.size(), mesh.nodes_mm.size() - 1);
  for (int k = 0; k < mesh.elements(); ++k) {
    const double middle = 0.5 * (mesh.nodes_mm[k] + mesh.nodes_mm[k + 1]);
    EXPECT_EQ(mesh.stiffness_ratio[k],
              middle < 17 ? 2.0 : (middle < 50 ? 0.5 : 1.0));
    EXPECT_FALSE(mesh.nodes_mm[k] < 50 && mesh.nodes_mm[k + 1] > 50);
  }
}

TEST(MeshTest, LocatesPoints) {
  BeamMesh mesh;
  mesh.nodes_mm = {0, 10, 25};
  EXPECT_EQ(mesh.Locate(0).element, 0);
  EXPECT_EQ(mesh.Locate(10).element, 1);
  EXPECT_EQ(mesh.Locate(12.5).offset_mm, 2.5);
  EXPECT_EQ(mesh.Locate(25).element, 1);
  EXPECT_EQ(mesh.Locate(25).offset_mm, 15);
}

}  // namespace
}  // namespace finray
