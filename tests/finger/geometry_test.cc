#include "finray/finger/geometry.h"

#include <gtest/gtest.h>

#include <cmath>

#include "test_finger.h"

namespace finray {
namespace {

TEST(GeometryTest, PaperFinger) {
  const Finger finger = PaperFinger();
  const Eigen::Vector2d base = BeamBase(finger, Side::kBack);
  EXPECT_NEAR(base.x(), 56.5637, 5e-5);
  EXPECT_EQ(base.y(), 0);
  // Pythagoras over the triangle of base, base and tip.
  EXPECT_NEAR(BeamLength(finger, Side::kBack), std::hypot(140, base.x()),
              1e-12);
  const Eigen::Vector2d tip =
      UndeformedPoint(finger, Side::kBack, BeamLength(finger, Side::kBack));
  EXPECT_NEAR(tip.x(), 0, 1e-12);
  EXPECT_NEAR(tip.y(), 140, 1e-12);
}

TEST(GeometryTest, RibsMeetTheBackBeamInTheirDirection) {
  const Finger finger = PaperFinger();
  const double front[] = {17, 39, 61, 83, 105};
  const double angle[] = {10, 13, 16, 19, 22};
  for (int i = 0; i < 5; ++i) {
    const Rib& rib = finger.ribs[i];
    const Eigen::Vector2d to =
        UndeformedPoint(finger, Side::kBack, rib.back_mm);
    EXPECT_NEAR(std::atan2(to.y() - front[i], to.x()) * 180 / M_PI, angle[i],
                1e-10);
    // Law of sines in the triangle of hinge, hinge and tip.
    const double at_tip = M_PI / 2 - (M_PI - finger.back_angle_rad);
    const double at_front = M_PI / 2 - angle[i] * M_PI / 180;
    const double length = (140 - front[i]) * std::sin(at_tip) /
                          std::sin(M_PI - at_tip - at_front);
    EXPECT_NEAR(NominalRibLength(finger, rib), length, 1e-10);
    EXPECT_EQ(rib.length_mm, NominalRibLength(finger, rib));
  }
}

TEST(GeometryTest, ForceUnit) {
  Finger finger = PaperFinger();
  finger.front_stiffness_N_mm2 = 4 * 19600;
  finger.back_stiffness_N_mm2 = 9 * 19600;
  EXPECT_NEAR(ForceUnit(finger), 6, 1e-12);
}

TEST(GeometryTest, ARibAlongTheBackBeamNeverMeetsIt) {
  const Finger finger = PaperFinger();
  EXPECT_TRUE(std::isnan(RibBackArc(finger, 50, finger.back_angle_rad)));
}

}  // namespace
}  // namespace finray
