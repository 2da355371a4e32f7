#include "finray/scene/simulation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "estimation/log_readings.h"
#include "finray/batch/batch_estimation.h"
#include "finray/finger/geometry.h"
#include "finray/io/error.h"
#include "temp_file.h"
#include "test_finger.h"

namespace finray {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

class SimulationTest : public testing::Test {
 protected:
  FrameTable Load(const std::string& text) {
    return FrameTable::Read(folder_.Write("in.csv", text));
  }
  TempFolder folder_;
  Finger finger_ = PaperFinger();
};

TEST_F(SimulationTest, PointsObjectsAndFreeRows) {
  FrameTable frames = Load(
      "contact_1_mm,normal_1_N,contact_2_mm,normal_2_N,object_x_mm,object_y_mm,"
      "note\n50,2,,,,,one\n50,2,90,1,,,two\n,,,,-12,70,object\n,,,,,,none\n");
  Scene scene;
  scene.object = RigidObject{Outline(CircleOutline{15}), {}};
  FrameTable shapes;
  const SimulationSummary summary =
      Simulate(finger_, scene, {}, &frames, &shapes);
  EXPECT_EQ(summary.contact, 3);
  EXPECT_EQ(summary.free, 1);
  EXPECT_EQ(shapes.rows(), 4u * 202u);
  EquilibriumSolver solver(finger_, {});
  ASSERT_TRUE(solver.Solve({{50, 2, 0}, {90, 1, 0}}));
  EXPECT_NEAR(frames.Numbers("gauge_3_rad")[1], solver.gauge_angle(2), 1e-12);
  EXPECT_NEAR(frames.Numbers("rib_4_N")[1], solver.rib_tension(3), 1e-9);
  EXPECT_NEAR(frames.Numbers("contact_2_angle_rad")[1],
              solver.contact_pose(1).z(), 1e-12);
  // The object touches where its centre says, R away along the normal.
  const double x = frames.Numbers("contact_1_x_mm")[2];
  const double y = frames.Numbers("contact_1_y_mm")[2];
  EXPECT_NEAR(std::hypot(x + 12, y - 70), 15, 1e-9);
  EXPECT_GT(frames.Numbers("normal_1_N")[2], 1);
  EXPECT_EQ(frames.Numbers("force_N")[2], frames.Numbers("force_N")[2]);
  EXPECT_EQ(frames.Numbers("force_N")[3], 0);
  EXPECT_EQ(frames.MutableText("note")[2], "object");
}

TEST_F(SimulationTest, ObjectsTurnAndTouchSeveralTimes) {
  FrameTable frames = Load(
      "object_x_mm,object_y_mm,object_angle_deg\n-14,70,\n-23,70,30\n"
      "-60,70,0\n0,160,0\n");
  Scene scene;
  scene.object =
      RigidObject{Outline(RoundedPolygonOutline{
                      {{-20, -20}, {20, -20}, {20, 20}, {-20, 20}}, 2}),
                  {}};
  const SimulationSummary summary = Simulate(finger_, scene, {}, &frames);
  EXPECT_EQ(summary.contact, 2);
  EXPECT_EQ(summary.free, 1);
  EXPECT_EQ(summary.not_converged, 1);
  EXPECT_THAT(summary.first_failure,
              HasSubstr("in.csv:5: the object meets an end of the front beam"));
  EXPECT_FALSE(frames.Has("contact_3_mm"));
  EXPECT_FALSE(frames.Has("object_displacement_mm"));
  EXPECT_GT(frames.Numbers("normal_1_N")[0], 0);
  EXPECT_GT(frames.Numbers("normal_2_N")[0], 0);
  EXPECT_NEAR(frames.Numbers("contact_1_y_mm")[0], 50, 1);
  EXPECT_NEAR(frames.Numbers("contact_2_y_mm")[0], 90, 1);
  EXPECT_GT(frames.Numbers("normal_1_N")[1], 0);
  EXPECT_TRUE(std::isnan(frames.Numbers("normal_2_N")[1]));
  EXPECT_EQ(frames.Numbers("normal_1_N")[2], 0);
  EXPECT_EQ(frames.MutableText("status")[2], "no_contact");
  EXPECT_EQ(frames.MutableText("status")[3], "not_converged");
}

TEST_F(SimulationTest, HalfAPlaceIsAnError) {
  FrameTable frames = Load("object_x_mm,object_y_mm\n,\n-10,\n");
  Scene scene;
  scene.object = RigidObject{Outline(CircleOutline{15}), {}};
  EXPECT_THAT([&] { Simulate(finger_, scene, {}, &frames); },
              ThrowsMessage<InputError>(HasSubstr(
                  "in.csv:3: object_x_mm and object_y_mm: expected both")));
}

TEST_F(SimulationTest, SaysWhereAPathOfLoadsEnds) {
  FrameTable frames = Load("contact_1_mm,normal_1_N\n70,2\n130,200\n");
  const SimulationSummary summary = Simulate(finger_, {}, {}, &frames);
  EXPECT_EQ(summary.not_converged, 1);
  EXPECT_THAT(summary.first_failure,
              HasSubstr("in.csv:3: the equilibrium ends at a limit point at "
                        "53.3 % of this load"));
  EXPECT_TRUE(std::isnan(frames.Numbers("gauge_1_V")[1]));
}

TEST_F(SimulationTest, AnObjectOnASpringGivesWay) {
  const std::string text = "object_x_mm,object_y_mm\n-11,70\n-40,70\n0,141\n";
  FrameTable sprung = Load(text), rigid = Load(text);
  Scene scene;
  scene.object = RigidObject{Outline(CircleOutline{15}), {}};
  Simulate(finger_, scene, {}, &rigid);
  scene.object->spring = ObjectSpring{2, M_PI};
  Simulate(finger_, scene, {}, &sprung);
  EXPECT_FALSE(rigid.Has("object_displacement_mm"));
  const auto& displacement = sprung.Numbers("object_displacement_mm");
  const double angle = sprung.Numbers("contact_1_angle_rad")[0];
  const double force = sprung.Numbers("normal_1_N")[0];
  EXPECT_NEAR(2 * displacement[0], force * std::sin(angle), 1e-9);
  EXPECT_LT(force, rigid.Numbers("normal_1_N")[0]);
  EXPECT_EQ(displacement[1], 0);
  // Pushed against the tip.
  EXPECT_EQ(sprung.MutableText("status")[2], "not_converged");
}

TEST_F(SimulationTest, BadLoadsNameTheirLine) {
  const auto error = [&](const std::string& text, const std::string& message) {
    FrameTable frames = Load(text);
    EXPECT_THAT([&] { Simulate(finger_, Scene(), {}, &frames); },
                ThrowsMessage<InputError>(HasSubstr(message)));
  };
  error("contact_1_mm,normal_1_N\n50,1\n150,2\n",
        "in.csv:3: contact_1_mm: expected an arc length on the front beam");
  error("contact_1_mm,normal_1_N\n50,-1\n",
        "in.csv:2: normal_1_N: expected a force of at least 0 N");
  error("contact_1_mm,normal_1_N\n50,\n", "in.csv:2: normal_1_N");
  error("contact_1_mm\n50\n", "no column 'normal_1_N'");
  error("object_x_mm,object_y_mm\n-10,50\n", "the scene has no object");
}

TEST_F(SimulationTest, ContactsOnTheBackBeam) {
  const std::string text =
      "contact_1_mm,normal_1_N,contact_2_mm,normal_2_N,friction_2\n"
      "50,2,145,1,0.3\n,,145,1,0.3\n";
  FrameTable frames = Load(text);
  const Scene scene = ReadScene(
      folder_.Write("s.yaml", "contacts: 2\ncontact_beams: [front, back]\n"));
  Simulate(finger_, scene, {}, &frames);
  EquilibriumSolver solver(finger_, {});
  const PointContact back{145, 1, 0.3, Side::kBack};
  ASSERT_TRUE(solver.Solve({{50, 2, 0}, back}));
  EXPECT_NEAR(frames.Numbers("gauge_3_rad")[0], solver.gauge_angle(2), 1e-12);
  EXPECT_NEAR(frames.Numbers("contact_2_x_mm")[0], solver.contact_pose(1).x(),
              1e-9);
  EXPECT_NEAR(frames.Numbers("force_N")[1], std::hypot(1, 0.3), 1e-12);
  const double theta = solver.contact_pose(1).z();
  const Eigen::Vector3d front = solver.contact_pose(0);
  const Eigen::Vector2d sum =
      2 * Eigen::Vector2d(std::sin(front.z()), -std::cos(front.z())) +
      Eigen::Vector2d(-std::sin(theta), std::cos(theta)) +
      0.3 * Eigen::Vector2d(std::cos(theta), std::sin(theta));
  EXPECT_NEAR(frames.Numbers("force_N")[0], sum.norm(), 1e-9);

  const auto error = [&](const std::string& beams, const std::string& loads,
                         const std::string& message) {
    const Scene other = ReadScene(folder_.Write("s.yaml", beams));
    FrameTable bad = Load(loads);
    EXPECT_THAT([&] { Simulate(finger_, other, {}, &bad); },
                ThrowsMessage<InputError>(HasSubstr(message)));
  };
  error("contact_beams: [front, back]\n",
        "contact_1_mm,normal_1_N,contact_2_mm,normal_2_N\n50,1,151,1\n",
        "in.csv:2: contact_2_mm: expected an arc length on the back beam, 0 to "
        "150.99");
  error("contact_beams: [back]\n", text,
        "s.yaml:1:16: contact_beams: expected a word for each of the 2 "
        "contacts in ");
}

TEST_F(SimulationTest, SimulateThenEstimateReturnsTheContact) {
  std::string text = "contact_1_mm,normal_1_N\n";
  for (int i = 0; i < 40; ++i) {
    text +=
        std::to_string(20 + 2 * i) + "," + std::to_string(0.5 + 0.2 * i) + "\n";
  }
  Finger rich = finger_;
  rich.front_pieces = {{50.3, 1}, {140, 0.7}};
  rich.back_pieces = {{70, 1}, {BeamLength(rich, Side::kBack), 1.4}};
  rich.front_axial_stiffness_N = 2e4;
  rich.back_axial_stiffness_N = 1e4;
  for (const Finger& finger : {finger_, rich}) {
    FrameTable frames = Load(text);
    const auto arc = frames.Numbers("contact_1_mm");
    const auto force = frames.Numbers("normal_1_N");
    Simulate(finger, Scene(), {}, &frames);
    const auto readings = ReadReadings(finger, frames);
    const auto one = EstimateFrames(finger, Scene(), {}, readings, 1);
    const auto two = EstimateFrames(finger, Scene(), {}, readings, 2);
    int ok = 0;
    for (int i = 0; i < 40; ++i) {
      const ContactEstimate& contact = one[i].contact[0];
      ok += one[i].status == FrameStatus::kOk;
      EXPECT_NEAR(contact.arc_mm, arc[i], 1e-5);
      EXPECT_NEAR(contact.normal_N, force[i], 1e-6 * force[i]);
      EXPECT_EQ(contact.arc_mm, two[i].contact[0].arc_mm);
      EXPECT_EQ(contact.normal_N, two[i].contact[0].normal_N);
    }
    EXPECT_GE(ok, 36);
  }
}

TEST_F(SimulationTest, ALogHasNoiseAndNoTruth) {
  std::string text = "object_x_mm,object_y_mm\n";
  for (int i = 0; i < 400; ++i) text += "-13,70\n";
  FrameTable frames = Load(text);
  Scene scene;
  scene.object = RigidObject{Outline(CircleOutline{15}), {}};
  Simulate(finger_, scene, {}, &frames);
  const FrameTable log = MakeLog(finger_, frames, {0.02, 0.05, 4});
  EXPECT_FALSE(log.Has("contact_1_mm"));
  EXPECT_FALSE(log.Has("gauge_1_rad"));
  const auto std = [&](const char* name) {
    double squares = 0;
    for (int i = 0; i < 400; ++i) {
      squares += std::pow(log.Numbers(name)[i] - frames.Numbers(name)[i], 2);
    }
    return std::sqrt(squares / 400);
  };
  EXPECT_NEAR(std("gauge_2_V"), 3e-4, 5e-5);
  EXPECT_NEAR(std("force_N"), 0.02, 3e-3);
  EXPECT_NEAR(std("object_y_mm"), 0.05, 8e-3);
  EXPECT_EQ(MakeLog(finger_, frames, {0.02, 0.05, 4}).ToCsv(), log.ToCsv());
  EXPECT_NE(MakeLog(finger_, frames, {0.02, 0.05, 5}).ToCsv(), log.ToCsv());
}

TEST_F(SimulationTest, PinsAreARibApart) {
  FrameTable frames(1);
  frames.MutableNumbers("contact_1_mm") = {62};
  frames.MutableNumbers("normal_1_N") = {4};
  Simulate(finger_, {}, {}, &frames);
  for (int i = 0; i < 5; ++i) {
    const std::string rib = "rib_" + std::to_string(i + 1);
    const auto apart = [&](const std::string& axis) {
      return frames.Numbers(rib + "_back_" + axis + "_mm")[0] -
             frames.Numbers(rib + "_front_" + axis + "_mm")[0];
    };
    EXPECT_NEAR(std::hypot(apart("x"), apart("y")), finger_.ribs[i].length_mm,
                1e-9);
  }
  EXPECT_FALSE(MakeLog(finger_, frames, {0, 0, 1}).Has("rib_1_front_x_mm"));
  EXPECT_NEAR(
      MakeLog(finger_, frames, {0, 0, 1, 0.5}).Numbers("rib_1_front_x_mm")[0],
      frames.Numbers("rib_1_front_x_mm")[0], 2.5);
}

}  // namespace
}  // namespace finray
