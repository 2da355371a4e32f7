#include "finray/calib/analysis/plausibility.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>
#include <utility>
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

// Swapped x and y let the circle touch near the base, with hardly a force.
TEST(PlausibilityTest, RefusesSwappedCoordinates) {
  std::vector<double> x, y;
  RefusalOf({"object_x_mm"}, [&](double mm) { return x.emplace_back(mm); });
  RefusalOf({"object_y_mm"}, [&](double mm) { return y.emplace_back(mm); });
  std::size_t i = 0;
  EXPECT_THAT(RefusalOf({"object_x_mm", "object_y_mm"},
                        [&](double) {
                          const std::size_t k = i++;
                          return k < y.size() ? y[k] : x[k - y.size()];
                        }),
              HasSubstr("are object_x_mm and object_y_mm swapped?"));
}

const std::vector<std::string> kGaugeColumns = {"gauge_1_V", "gauge_2_V",
                                                "gauge_3_V", "gauge_4_V"};

TEST(PlausibilityTest, RefusesGaugesInOtherUnits) {
  EXPECT_THAT(RefusalOf(kGaugeColumns, [](double v) { return 1000 * v; }),
              HasSubstr("are these mV or counts?"));
  EXPECT_THAT(
      RefusalOf(kGaugeColumns,
                [](double v) { return std::round(32768 + 6553.6 * v); }),
      HasSubstr("are these mV or counts?"));
  // Wherever the object is.
  EXPECT_THAT(RefusalOf(
                  kGaugeColumns, [](double v) { return 1000 * v; }, true),
              HasSubstr("are these mV or counts?"));
  // An amplifier is no other unit.
  EXPECT_THAT(RefusalOf(kGaugeColumns, [](double v) { return 20 * v; }),
              IsEmpty());
}

TEST(PlausibilityTest, RefusesDeadGauges) {
  EXPECT_THAT(RefusalOf({"gauge_3_V"}, [](double) { return 0.1; }),
              HasSubstr("gauge 3 is stuck at 0.1 V from row 1 to 210"));
  int i = 0;
  EXPECT_THAT(
      RefusalOf({"gauge_2_V"}, [&](double) { return 1e-3 * (++i % 7); }),
      HasSubstr("gauge_2_V does not respond"));
  EXPECT_THAT(RefusalOf(kGaugeColumns, [](double) { return 0.1; }),
              HasSubstr("gauges 1 to 4 do not move in 210 rows, not even by "
                        "their noise, while force_N varies by"));
}

TEST(PlausibilityTest, RefusesAGaugeOfTheWrongSign) {
  EXPECT_THAT(RefusalOf({"gauge_4_V"}, [](double v) { return -v; }),
              HasSubstr("gauge_4_V falls where the finger's gain"));
}

TEST(PlausibilityTest, RefusesSwappedGauges) {
  for (const auto& [a, b] :
       {std::pair(1, 2), std::pair(2, 3), std::pair(3, 4), std::pair(1, 4)}) {
    std::vector<double> of_a, of_b;
    const std::string name_a = "gauge_" + std::to_string(a) + "_V";
    const std::string name_b = "gauge_" + std::to_string(b) + "_V";
    RefusalOf({name_a}, [&](double v) { return of_a.emplace_back(v); });
    RefusalOf({name_b}, [&](double v) { return of_b.emplace_back(v); });
    std::size_t i = 0;
    EXPECT_THAT(RefusalOf({name_a, name_b},
                          [&](double) {
                            const std::size_t k = i++;
                            return k < of_b.size() ? of_b[k]
                                                   : of_a[k - of_b.size()];
                          }),
                HasSubstr(name_a + " bends as gauge " + std::to_string(b)));
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

// A stage may count from the base, from the tip, or from the end of its way.
TEST(PlausibilityTest, RefusesYOfALeftHandedStage) {
  for (const double mirror : {0.0, 140.0, 120.0}) {
    EXPECT_THAT(
        RefusalOf({"object_y_mm"}, [&](double y) { return mirror - y; }),
        HasSubstr("if y ran the other way"))
        << mirror;
  }
}

}  // namespace
}  // namespace finray
