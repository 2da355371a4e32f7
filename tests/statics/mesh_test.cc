#include "finray/statics/mesh.h"

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
      const BeamMesh mesh =
          MakeBeamMesh(finger, side, {Scheme::kTaylor, resolution});
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
