#include "finray/calib/calibration_log.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

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
  for (int i = 0; i < 6; ++i) EXPECT_EQ(logs.frames[i].contact, expected[i]);
  plan.scene.contacts = 1;
  EXPECT_TRUE(
      ReadCalibrationLogs({path}, PaperFinger(), plan).frames[1].contact);
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
  EXPECT_EQ(count(ReadCalibrationLogs({path}, PaperFinger(), plan)), 20);
  plan.holdout_by = HoldoutBy::kLog;
  EXPECT_EQ(count(ReadCalibrationLogs({path, path, path}, PaperFinger(), plan)),
            100);
  EXPECT_THAT([&] { ReadCalibrationLogs({path}, PaperFinger(), plan); },
              ThrowsMessage<InputError>(HasSubstr("at least 2 logs")));
}

TEST(CalibrationLogTest, MissingGaugeNamesTheColumn) {
  const TempFolder folder;
  const std::string path = folder.Write(
      "a.csv", "gauge_1_V,gauge_2_V,gauge_3_V,gauge4_V\n1,1,1,1\n");
  EXPECT_THAT([&] { ReadCalibrationLogs({path}, PaperFinger(), Plan()); },
              ThrowsMessage<InputError>(HasSubstr(
                  "no column 'gauge_4_V' (did you mean 'gauge4_V'?)")));
}

}  // namespace
}  // namespace finray
