#include "finray/view/finger_picture.h"

#include <gtest/gtest.h>

#include <cmath>

#include "finray/finger/finger_yaml.h"
#include "finray/statics/shape.h"

namespace finray {
namespace {

class FingerPictureTest : public testing::Test {
 protected:
  const Finger finger_ =
      ReadFinger(FINRAY_SOURCE_DIR "/configs/fingers/paper_140mm.yaml");
  const PictureNodes nodes_{finger_};
  EquilibriumSolver solver_{finger_, {}};
};

TEST_F(FingerPictureTest, RibsEndAtTheirHingesAndKeepTheirLengths) {
  const std::vector<PointContact> contacts = {{70, 4, 0}};
  ASSERT_TRUE(solver_.Solve(contacts));
  const std::vector<double> places = nodes_.Places(solver_, contacts);
  ASSERT_EQ(places.size(), 2 * nodes_.size());
  const Shape shape(solver_, contacts);
  for (const Rib& rib : finger_.ribs) {
    const Section front = shape.At(Side::kFront, rib.front_mm);
    const Section back = shape.At(Side::kBack, rib.back_mm);
    // The nodes nearest to the hinges are there.
    double front_off = 1e9, back_off = 1e9;
    for (std::size_t i = 0; i < places.size(); i += 2) {
      front_off = std::min(front_off, std::hypot(places[i] - front.x_mm,
                                                 places[i + 1] - front.y_mm));
      back_off = std::min(back_off, std::hypot(places[i] - back.x_mm,
                                               places[i + 1] - back.y_mm));
    }
    EXPECT_LT(front_off, 1e-9);
    EXPECT_LT(back_off, 1e-9);
    EXPECT_NEAR(std::hypot(front.x_mm - back.x_mm, front.y_mm - back.y_mm),
                rib.length_mm, 1e-6);
  }
}

TEST_F(FingerPictureTest, TableIsGoodWhereItSaysSo) {
  const ShapeTable table = MakeShapeTable(finger_, {}, nodes_, 0, 0, 8);
  EXPECT_EQ(table.moves_mm.size(),
            table.arcs_mm.size() * table.forces_N.size());
  // A pixel of a picture of 500 pixels is 0.28 mm.
  EXPECT_LT(table.largest_error_mm, 0.05);
  EXPECT_GT(table.largest_error_mm, 0);
  // At a node of the grid it is the solution.
  const std::vector<PointContact> contacts = {
      {table.arcs_mm[30], table.forces_N[20], 0}};
  ASSERT_TRUE(solver_.Solve(contacts));
  const std::vector<double> places = nodes_.Places(solver_, contacts);
  const std::vector<double> undeformed = nodes_.Undeformed();
  const std::vector<double>& moves =
      table.moves_mm[20 * table.arcs_mm.size() + 30];
  for (std::size_t i = 0; i < places.size(); ++i) {
    EXPECT_NEAR(undeformed[i] + moves[i], places[i], 1e-8);
  }
}

TEST_F(FingerPictureTest, TableIsGoodAtAllFrictions) {
  const ShapeTable table = MakeShapeTable(finger_, {}, nodes_, -0.3, 0.3, 8);
  EXPECT_EQ(table.frictions, (std::vector<double>{-0.3, 0, 0.3}));
  EXPECT_LT(table.largest_error_mm, 0.08);
  // The order is that of the header.
  const std::vector<PointContact> contacts = {
      {table.arcs_mm[40], table.forces_N[20], -0.3}};
  ASSERT_TRUE(solver_.Solve(contacts));
  const std::vector<double> places = nodes_.Places(solver_, contacts);
  const std::vector<double> undeformed = nodes_.Undeformed();
  const std::vector<double>& moves =
      table.moves_mm[20 * 3 * table.arcs_mm.size() + 40];
  for (std::size_t i = 0; i < places.size(); ++i) {
    EXPECT_NEAR(undeformed[i] + moves[i], places[i], 1e-8);
  }
}

TEST_F(FingerPictureTest, WithoutAnEquilibriumTheTableHasNoShape) {
  Finger soft = finger_;
  soft.front_stiffness_N_mm2 = soft.back_stiffness_N_mm2 = 20;
  const PictureNodes nodes(soft);
  const ShapeTable table = MakeShapeTable(soft, {}, nodes, 0, 0, 500);
  bool any = false;
  for (const auto& moves : table.moves_mm) any = any || std::isnan(moves[0]);
  EXPECT_TRUE(any);
  EXPECT_TRUE(std::isfinite(table.largest_error_mm));
}

}  // namespace
}  // namespace finray
