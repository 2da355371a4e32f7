#include "finray/calib/problem/calibration_log.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "finray/io/error.h"
#include "temp_file.h"
#include "test_finger.h"

namespace finray {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

const char kGauges[] = "gauge_1_V,gauge_2_V,gauge_3_V,gauge_4_V";

TEST(CalibrationLogTest, DecidesWhatTouches) {
  const TempFolder folder;
  const std::string path = folder.Write(
      "a.csv",
      std::string(kGauges) +
          ",force_N,object_x_mm,object_y_mm\n"
          "0,0,0,0,1.0,-14,70\n"    // force
          "0,0,0,0,-0.01,-14,70\n"  // no force, though slightly negative
          "0,0,0,0,,-14,70\n"       // reaches 1 mm in
          "0,0,0,0,,-15,70\n"       // just touches
          "0,0,0,0,,-5,160\n"       // passes above the tip
          "0,0,0,0,,,\n");          // nothing known
  Plan plan;
  plan.scene.object = RigidObject{Outline(CircleOutline{15}), {}};
  const CalibrationLogs logs = ReadCalibrationLogs({path}, PaperFinger(), plan);
  const bool expected[] = {true, false, true, false, false, true};
  const bool undecided[] = {false, true, false, true, false, false};
  for (int i = 0; i < 6; ++i) {
    EXPECT_EQ(logs.frames[i].contact, expected[i]) << i;
    EXPECT_EQ(logs.frames[i].undecided, undecided[i]) << i;
  }
  plan.scene.contacts = 1;
  EXPECT_TRUE(
      ReadCalibrationLogs({path}, PaperFinger(), plan).frames[1].contact);
}

// The plan's std is 0.02 N. The object is 5 mm away from the finger.
TEST(CalibrationLogTest, NoiseOfTwoAxesIsNoTouch) {
  const TempFolder folder;
  const std::string path =
      folder.Write("a.csv", std::string(kGauges) +
                                ",force_x_N,force_y_N,object_x_mm,object_y_mm\n"
                                "0,0,0,0,0.045,0.045,-20,70\n"  // 3.18 std
                                "0,0,0,0,-0.06,-0.06,-20,70\n"  // 4.24 std
                                "0,0,0,0,0.15,0.0,-20,70\n"     // 7.5 std
                                "0,0,0,0,0.06,0.06,,\n");
  Plan plan;
  plan.scene.object = RigidObject{Outline(CircleOutline{15}), {}};
  const CalibrationLogs logs = ReadCalibrationLogs({path}, PaperFinger(), plan);
  const bool contact[] = {false, true, true, true};
  // Force and object contradict each other, and the force is weak.
  const bool undecided[] = {false, true, false, false};
  for (int i = 0; i < 4; ++i) {
    EXPECT_EQ(logs.frames[i].contact, contact[i]) << i;
    EXPECT_EQ(logs.frames[i].undecided, undecided[i]) << i;
  }
}

TEST(CalibrationLogTest, HoldsOutBlocksAndLogs) {
  const TempFolder folder;
  std::string text = std::string(kGauges) + "\n";
  for (int i = 0; i < 100; ++i) text += "0,0,0,0\n";
  const std::string path = folder.Write("a.csv", text);
  Plan plan;
  plan.holdout_by = HoldoutBy::kBlock;
  const auto count = [](const CalibrationLogs& logs) {
    return std::count_if(logs.frames.begin(), logs.frames.end(),
                         [](const auto& frame) { return frame.held_out; });
  };
  for (const double fraction : {0.1, 0.2, 0.4, 0.5, 0.7}) {
    plan.holdout_fraction = fraction;
    EXPECT_EQ(count(ReadCalibrationLogs({path}, PaperFinger(), plan)),
              std::lround(100 * fraction));
  }
  plan.holdout_fraction = 0.2;
  plan.holdout_by = HoldoutBy::kLog;
  EXPECT_EQ(count(ReadCalibrationLogs({path, path, path}, PaperFinger(), plan)),
            100);
  EXPECT_THAT([&] { ReadCalibrationLogs({path}, PaperFinger(), plan); },
              ThrowsMessage<InputError>(HasSubstr("at least 2 logs")));
}

TEST(CalibrationLogTest, TheBenchIsNotHeldOut) {
  const TempFolder folder;
  std::string text = std::string(kGauges) + "\n";
  for (int i = 0; i < 20; ++i) text += "0,0,0,0\n";
  const std::vector<std::string> paths = {
      folder.Write("bench.csv",
                   std::string(kGauges) + ",cylinder_radius_mm\n1,1,1,1,inf\n"),
      folder.Write("a.csv", text), folder.Write("b.csv", text)};
  Plan plan;
  for (const HoldoutBy by : {HoldoutBy::kLog, HoldoutBy::kBlock}) {
    plan.holdout_by = by;
    plan.holdout_fraction = 0.5;
    const CalibrationLogs logs =
        ReadCalibrationLogs(paths, PaperFinger(), plan);
    EXPECT_FALSE(logs.frames[0].held_out);
    EXPECT_EQ(std::count_if(logs.frames.begin(), logs.frames.end(),
                            [](const auto& frame) { return frame.held_out; }),
              20);
  }
}

TEST(CalibrationLogTest, MissingGaugeNamesTheColumn) {
  const TempFolder folder;
  const std::string path = folder.Write(
      "a.csv", "gauge_1_V,gauge_2_V,gauge_3_V,gauge4_V\n1,1,1,1\n");
  EXPECT_THAT([&] { ReadCalibrationLogs({path}, PaperFinger(), Plan()); },
              ThrowsMessage<InputError>(HasSubstr(
                  "no column 'gauge_4_V' (did you mean 'gauge4_V'?)")));
}

// Without them it would be another calibration, and look like a good one.
TEST(CalibrationLogTest, NearlyNamedColumnsAreNotLeftOut) {
  const TempFolder folder;
  const auto refuses = [&](const std::string& columns,
                           const std::string& message) {
    const std::string path = folder.Write(
        "a.csv", std::string(kGauges) + "," + columns + "\n0,0,0,0,1,2,3\n");
    EXPECT_THAT([&] { ReadCalibrationLogs({path}, PaperFinger(), Plan()); },
                ThrowsMessage<InputError>(HasSubstr(message)));
  };
  refuses("force_N,object_x_m,object_y_mm",
          "no column 'object_x_mm' (did you mean 'object_x_m'?)");
  refuses("force_mN,object_x_mm,object_y_mm",
          "no column 'force_N' (did you mean 'force_mN'?)");
  refuses("force_x_N,object_x_mm,object_y_mm", "no column 'force_y_N'");
}

TEST(CalibrationLogTest, RefusesHugeNumbers) {
  const TempFolder folder;
  for (const char* row :
       {"0,0,-1e16,0,1\n", "0,0,0,0,1e308\n", "0,-inf,0,0,1\n"}) {
    const std::string path = folder.Write(
        "a.csv", std::string(kGauges) + ",force_N\n0,0,0,0,1\n" + row);
    EXPECT_THAT([&] { ReadCalibrationLogs({path}, PaperFinger(), Plan()); },
                ThrowsMessage<InputError>(testing::AllOf(
                    HasSubstr(path + ":3:"),
                    HasSubstr("expected a magnitude of at most 1e+09"))));
  }
}

TEST(CalibrationLogTest, RefusesParametersWithoutTheirData) {
  const TempFolder folder;
  const std::string path =
      folder.Write("a.csv", std::string(kGauges) + ",time_S\n0,0,0,0,1\n");
  const auto error = [&](ParameterFamily family, const std::string& message) {
    Plan plan;
    plan.families[static_cast<int>(family)].free = true;
    EXPECT_THAT([&] { ReadCalibrationLogs({path}, PaperFinger(), plan); },
                ThrowsMessage<InputError>(HasSubstr(message)));
  };
  error(ParameterFamily::kGaugeDrift,
        "a.csv: no column 'time_s' (did you mean 'time_S'?); the plan's "
        "gauge_drift needs it");
  error(ParameterFamily::kTemperatureCoefficient,
        "no column 'temperature_C'; it has gauge_1_V gauge_2_V gauge_3_V "
        "gauge_4_V time_S; the plan's temperature_coefficient needs it");
  error(ParameterFamily::kForceScale,
        "plan: force_scale is free, but no log has a force_N");
  error(ParameterFamily::kForceOffset, "plan: force_offset is free");
  error(ParameterFamily::kCameraOrigin, "plan: camera_origin is free");
  Plan plan;
  plan.pin_std_mm = 0.5;
  EXPECT_THAT([&] { ReadCalibrationLogs({path}, PaperFinger(), plan); },
              ThrowsMessage<InputError>(HasSubstr("rib_1_front_x_mm")));
}

TEST(CalibrationLogTest, TimeAndTemperatureLastUntilTheNext) {
  const TempFolder folder;
  const std::string path = folder.Write(
      "a.csv", std::string(kGauges) +
                   ",time_s,temperature_C\n"
                   "0,0,0,0,,\n0,0,0,0,5,20\n0,0,0,0,,21\n0,0,0,0,7,\n");
  Plan plan;
  for (const ParameterFamily family :
       {ParameterFamily::kGaugeDrift,
        ParameterFamily::kTemperatureCoefficient}) {
    plan.families[static_cast<int>(family)].free = true;
  }
  const auto frames = ReadCalibrationLogs({path}, PaperFinger(), plan).frames;
  const double times[] = {5, 5, 5, 7}, temperatures[] = {20, 20, 21, 21};
  for (int i = 0; i < 4; ++i) {
    EXPECT_EQ(frames[i].time_s, times[i]);
    EXPECT_EQ(frames[i].temperature_C, temperatures[i]);
  }
}

TEST(CalibrationLogTest, PinsStandInForGauges) {
  const TempFolder folder;
  const std::string path = folder.Write(
      "a.csv",
      "rib_2_front_x_mm,rib_2_front_y_mm,rib_4_back_x_mm,rib_4_back_y_mm\n"
      "1,40,30,90\n1,,30,91\n");
  Plan plan;
  plan.pin_std_mm = 0.5;
  const auto frames = ReadCalibrationLogs({path}, PaperFinger(), plan).frames;
  ASSERT_EQ(frames[0].pins.size(), 2u);
  EXPECT_EQ(frames[0].pins[1].rib, 3);
  EXPECT_EQ(frames[0].pins[1].side, Side::kBack);
  EXPECT_EQ(frames[0].pins[1].at_mm.y(), 90);
  EXPECT_EQ(frames[1].pins.size(), 1u);
}

TEST(CalibrationLogTest, BenchRowsAndNames) {
  const TempFolder folder;
  std::filesystem::create_directory(folder.Path("day2"));
  const std::string text =
      std::string(kGauges) + ",cylinder_radius_mm\n1,1,1,1,inf\n2,1,1,1,80\n";
  const std::vector<std::string> paths = {folder.Write("a.csv", text),
                                          folder.Write("day2/a.csv", text),
                                          folder.Write("b.csv", text)};
  const CalibrationLogs logs =
      ReadCalibrationLogs(paths, PaperFinger(), Plan());
  EXPECT_TRUE(logs.frames[0].IsBench());
  EXPECT_FALSE(logs.frames[0].contact);
  EXPECT_EQ(logs.names,
            (std::vector<std::string>{paths[0], paths[1], "b.csv"}));
  const std::string zero = folder.Write(
      "z.csv", std::string(kGauges) + ",cylinder_radius_mm\n1,1,1,1,0\n");
  EXPECT_THAT([&] { ReadCalibrationLogs({zero}, PaperFinger(), Plan()); },
              ThrowsMessage<InputError>(
                  HasSubstr("z.csv:2: cylinder_radius_mm: expected a radius")));
}

// A sensor with an unknown offset cannot say what touches; the object can.
TEST(CalibrationLogTest, TouchesWithAnOffsetOfTheForceSensor) {
  const TempFolder folder;
  const std::string path =
      folder.Write("a.csv", std::string(kGauges) +
                                ",force_N,object_x_mm,object_y_mm\n"
                                "0,0,0,0,0.2,-25,70\n"
                                "0,0,0,0,0.2,-14,70\n"
                                "0,0,0,0,0.2,,\n"
                                "0,0,0,0,0.4,,\n");
  Plan plan;
  plan.scene.object = RigidObject{Outline(CircleOutline{15}), {}};
  FamilyPlan& offset =
      plan.families[static_cast<int>(ParameterFamily::kForceOffset)];
  offset.free = true;
  offset.prior_std = 0.1;
  const bool expected[] = {false, true, false, true};
  const auto frames = ReadCalibrationLogs({path}, PaperFinger(), plan).frames;
  for (int i = 0; i < 4; ++i) EXPECT_EQ(frames[i].contact, expected[i]);
}

}  // namespace
}  // namespace finray
