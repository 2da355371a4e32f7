#include "finray/calib/design/finger_check.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "finray/finger/geometry.h"
#include "finray/statics/equilibrium.h"
#include "temp_file.h"
#include "test_finger.h"

namespace finray {
namespace {

using testing::Contains;
using testing::HasSubstr;

std::vector<std::string> Codes(const Finger& finger,
                               const std::vector<WrittenPlate>& plates = {}) {
  std::vector<std::string> codes;
  for (const Warning& warning : CheckFinger(finger, plates, {}).warnings) {
    codes.push_back(warning.code);
  }
  return codes;
}

// A finger without ribs is two cantilevers whose tips keep their angle. By
// Castigliano's theorem, with the moments of both beams of a frame that is
// clamped at both bases, its stiffness under a small force is a closed form;
// here the frame equations are integrated by themselves.
TEST(FingerCheckTest, StiffnessIsThatOfThePortalFrame) {
  Finger finger = PaperFinger();
  finger.ribs.clear();
  const FingerCheck check = CheckFinger(finger, {}, {});
  // Unknown: the wrench (X, Y, M) that the back beam exerts on the tip. The
  // complementary energy U = int m^2 / 2 EI over both beams is least.
  const double l = 140, contact = 70, ei = 12500;
  const Eigen::Vector2d tip(0, l);
  Eigen::Matrix4d energy = Eigen::Matrix4d::Zero();  // by (X, Y, M, F)
  constexpr int kSteps = 4000;
  for (const Side side : {Side::kFront, Side::kBack}) {
    const double length = BeamLength(finger, side);
    for (int i = 0; i < kSteps; ++i) {
      const double s = (i + 0.5) * length / kSteps;
      const Eigen::Vector2d to_tip = tip - UndeformedPoint(finger, side, s);
      Eigen::Vector4d m(-to_tip.y(), to_tip.x(), 1, 0);
      if (side == Side::kFront && s < contact) m[3] = -(contact - s);
      energy += m * m.transpose() * (length / kSteps / ei);
    }
  }
  const Eigen::Matrix3d a = energy.topLeftCorner<3, 3>();
  const Eigen::Vector3d b = energy.topRightCorner<3, 1>();
  const double compliance = energy(3, 3) - b.dot(a.inverse() * b);
  EXPECT_NEAR(check.heights[1].stiffness_N_per_mm * compliance, 1, 1e-3);
  EXPECT_NEAR(check.back_length_mm, l / std::sin(112 * kDegree), 1e-9);
}

// The angle per N is the slope of the angle itself.
TEST(FingerCheckTest, AnglesPerForce) {
  const Finger finger = PaperFinger();
  const FingerCheck check = CheckFinger(finger, {}, {});
  EquilibriumSolver solver(finger, {});
  ASSERT_TRUE(solver.Solve({{70, 0.01}}));
  for (int j = 0; j < 4; ++j) {
    EXPECT_NEAR(check.heights[1].angle_rad_per_N[j],
                solver.gauge_angle(j) / 0.01, 1e-4);
  }
  EXPECT_FALSE(check.limit.folds);
}

// A soft column under assembly prestress folds, and a force below the limit is
// carried.
TEST(FingerCheckTest, TheLimitLoadIsOne) {
  Finger finger = PaperFinger();
  finger.ribs.clear();
  const FingerCheck check = CheckFinger(finger, {}, {});
  ASSERT_TRUE(check.limit.folds);
  EXPECT_THAT(Codes(finger), Contains("folds"));
  EquilibriumSolver solver(finger, {});
  EXPECT_TRUE(solver.Solve({{70, 0.99 * check.limit.force_N}}));
  solver.Reset();
  EXPECT_FALSE(solver.Solve({{70, 1.01 * check.limit.force_N}}));
}

TEST(FingerCheckTest, ThePaperFingerIsOnlyUncalibrated) {
  EXPECT_EQ(Codes(PaperFinger()), std::vector<std::string>{"uncalibrated"});
  const Finger printed =
      ReadFinger(FINRAY_SOURCE_DIR "/configs/fingers/printed_100mm.yaml");
  EXPECT_EQ(Codes(printed, ReadPlates(FINRAY_SOURCE_DIR
                                      "/configs/fingers/printed_100mm.yaml")),
            std::vector<std::string>{"uncalibrated"});
}

TEST(FingerCheckTest, ImplausibleNumbersAreNamed) {
  const Finger paper = PaperFinger();
  EXPECT_THAT(Codes(paper, {{Side::kFront, "", 20, 1.4, 2100}}),
              Contains("modulus"));
  EXPECT_THAT(Codes(paper, {{Side::kFront, "", 20, 14, 2.1}}),
              Contains("thickness"));
  EXPECT_THAT(Codes(paper, {{Side::kFront, "", 1.4, 6, 2.1}}),
              Contains("width"));
  Finger finger = paper;
  finger.front_stiffness_N_mm2 = finger.back_stiffness_N_mm2 = 0.0125;
  EXPECT_THAT(Codes(finger), Contains("stiffness"));
  finger = paper;
  finger.front_stiffness_N_mm2 *= 100;
  EXPECT_THAT(Codes(finger), Contains("stiffness_ratio"));
  finger = paper;
  finger.ribs[2].back_mm = finger.ribs[1].back_mm + 0.5;
  finger.ribs[2].front_mm = finger.ribs[1].front_mm + 1;
  finger.ribs[2].length_mm = NominalRibLength(finger, finger.ribs[2]);
  EXPECT_THAT(Codes(finger), Contains("ribs_close"));
  finger = paper;
  finger.ribs[4].length_mm += 0.3;
  EXPECT_THAT(Codes(finger), Contains("prestress"));
  finger = paper;
  finger.gauges[1].start_mm = 35;
  EXPECT_THAT(Codes(finger), Contains("gauges_overlap"));
  finger = paper;
  finger.gauges[1].noise_V = 0.05;
  EXPECT_THAT(Codes(finger), Contains("noise"));
  finger = paper;
  finger.gauges[0].length_mm = 0.01;
  EXPECT_THAT(Codes(finger), Contains("gauge_deaf"));
  finger = paper;
  finger.gauges.resize(1);
  EXPECT_THAT(Codes(finger), Contains("few_gauges"));
  finger = paper;
  finger.gauges[0].gain_V_per_rad = 2;
  EXPECT_TRUE(Codes(finger).empty());
}

TEST(FingerCheckTest, PlatesOfPiecesHaveTheirPlace) {
  const TempFolder folder;
  const std::string path = folder.Write(
      "f.yaml",
      "schema_version: 1\nname: f\n"
      "geometry: {front_length_mm: 100, back_angle_deg: 110}\n"
      "beams:\n"
      "  front: {width_mm: 20, thickness_mm: 1.4, youngs_modulus_GPa: 2.1}\n"
      "  back:\n"
      "    pieces:\n"
      "      - {end_mm: 50, width_mm: 20, thickness_mm: 2, "
      "youngs_modulus_GPa: 2.1}\n"
      "      - {width_mm: 20, thickness_mm: 1, youngs_modulus_GPa: 2100}\n");
  const std::vector<WrittenPlate> plates = ReadPlates(path);
  ASSERT_EQ(plates.size(), 3u);
  EXPECT_EQ(plates[2].thickness_mm, 1);
  EXPECT_THAT(plates[2].name, HasSubstr("f.yaml:9:"));
  const FingerCheck check = CheckFinger(ReadFinger(path), plates, {});
  EXPECT_THAT(check.warnings[0].text, HasSubstr("f.yaml:9:"));
}

}  // namespace
}  // namespace finray
