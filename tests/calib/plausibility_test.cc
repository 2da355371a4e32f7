#include "finray/calib/analysis/plausibility.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

#include "calib/standard_log.h"
#include "finray/io/error.h"

namespace finray {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

// What is said of the standard log after a change of some columns.
std::string RefusalOf(const std::vector<std::string>& columns,
                      const std::function<double(double)>& change,
                      bool origin_free = false) {
  static const FrameTable whole = MakeLog(
      HiddenFinger(), StandardFrames(HiddenFinger(), 31), {0.02, 0.05, 31});
  FrameTable log = whole;
  for (const std::string& column : columns) {
    for (double& cell : log.MutableNumbers(column)) cell = change(cell);
  }
  const TempFolder folder;
  log.Write(folder.Path("log.csv"));
  Plan plan = StandardPlan();
  plan.families[static_cast<int>(ParameterFamily::kObjectOrigin)].free =
      origin_free;
  CalibrationProblem problem(
      Nominal(), plan,
      ReadCalibrationLogs({folder.Path("log.csv")}, Nominal(), plan), {}, 2);
  try {
    RefuseImplausible(&problem);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(PlausibilityTest, TakesTheStandardLog) {
  EXPECT_THAT(RefusalOf({}, {}), IsEmpty());
  EXPECT_THAT(RefusalOf({}, {}, true), IsEmpty());
  // Wherever the stage has its origin.
  EXPECT_THAT(RefusalOf(
                  {"object_x_mm"}, [](double x) { return x + 250; }, true),
              IsEmpty());
}

TEST(PlausibilityTest, RefusesForcesInOtherUnits) {
  EXPECT_THAT(RefusalOf({"force_N"}, [](double f) { return 1000 * f; }),
              HasSubstr("the median force of frames with contact is"));
}

TEST(PlausibilityTest, RefusesObjectsOutOfReach) {
  EXPECT_THAT(RefusalOf({"object_x_mm"}, [](double x) { return 1000 * x; }),
              HasSubstr("can touch the finger in 0"));
}

TEST(PlausibilityTest, RefusesXOfTheWrongSign) {
  for (const bool origin_free : {false, true}) {
    EXPECT_THAT(RefusalOf(
                    {"object_x_mm"}, [](double x) { return -x; }, origin_free),
                HasSubstr("the force falls as object_x_mm rises"));
  }
}

TEST(PlausibilityTest, RefusesMetres) {
  const auto metres = [](double mm) { return mm / 1000; };
  for (const bool origin_free : {false, true}) {
    EXPECT_THAT(RefusalOf({"object_x_mm", "object_y_mm"}, metres, origin_free),
                HasSubstr("are object_x_mm and object_y_mm in mm"));
  }
  // One height is no contradiction.
  EXPECT_THAT(RefusalOf(
                  {"object_y_mm"}, [](double) { return 70; }, true),
              IsEmpty());
}

}  // namespace
}  // namespace finray
