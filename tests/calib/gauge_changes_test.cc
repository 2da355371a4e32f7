#include "finray/calib/analysis/gauge_changes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>

#include "calib/recorded_log.h"
#include "finray/calib/analysis/plausibility.h"
#include "finray/io/error.h"
#include "finray/io/nan.h"

namespace finray {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;

// What is said of a log after a change of the readings in each row.
std::string RefusalAfter(
    FrameTable log,
    const std::function<void(std::size_t row, std::array<double, 4>*)>&
        change) {
  for (std::size_t i = 0; i < log.rows(); ++i) {
    std::array<double, 4> volts;
    const auto cell = [&](int j) -> double& {
      return log.MutableNumbers("gauge_" + std::to_string(j + 1) + "_V")[i];
    };
    for (int j = 0; j < 4; ++j) volts[j] = cell(j);
    change(i, &volts);
    for (int j = 0; j < 4; ++j) cell(j) = volts[j];
  }
  const TempFolder folder;
  log.Write(folder.Path("log.csv"));
  CalibrationProblem problem(
      Nominal(), StandardPlan(),
      ReadCalibrationLogs({folder.Path("log.csv")}, Nominal(), StandardPlan()),
      {}, 2);
  try {
    RefuseImplausible(&problem);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

FrameTable CleanTouches() {
  return MakeLog(HiddenFinger(), StandardFrames(HiddenFinger(), 31),
                 {0.02, 0.05, 31});
}

TEST(GaugeChangesTest, TakesLogsWithoutAny) {
  const auto nothing = [](std::size_t, std::array<double, 4>*) {};
  EXPECT_THAT(RefusalAfter(CleanTouches(), nothing), IsEmpty());
  EXPECT_THAT(
      RefusalAfter(MakeLog(HiddenFinger(), RecordedFrames(HiddenFinger(), 5),
                           {0.02, 0.05, 5}),
                   nothing),
      IsEmpty());
  // Coarse steps all the time, and a drift.
  EXPECT_THAT(RefusalAfter(CleanTouches(),
                           [](std::size_t row, std::array<double, 4>* volts) {
                             (*volts)[1] += 1e-4 * static_cast<double>(row);
                             (*volts)[2] =
                                 0.005 * std::round((*volts)[2] / 0.005);
                           }),
              IsEmpty());
}

TEST(GaugeChangesTest, NamesTheRowOfAJump) {
  for (const double jump_V : {3.75, -0.6}) {
    EXPECT_THAT(
        RefusalAfter(CleanTouches(),
                     [&](std::size_t row, std::array<double, 4>* volts) {
                       for (double& v : *volts) v += row >= 100 ? jump_V : 0;
                     }),
        AllOf(HasSubstr("log.csv row 10"), HasSubstr("gauge_1_V jumps"),
              HasSubstr("gauge_4_V jumps")));
  }
}

// Two readings are no line, however many rows there are.
TEST(GaugeChangesTest, FewReadingsBeforeAreNoJump) {
  EXPECT_THAT(RefusalAfter(CleanTouches(),
                           [](std::size_t row, std::array<double, 4>* volts) {
                             if (row >= 40) return;
                             const bool read = row == 28 || row == 29;
                             (*volts)[1] = read ? 2 : kNaN;
                           }),
              IsEmpty());
}

TEST(GaugeChangesTest, NamesTheRowOfAnotherGain) {
  EXPECT_THAT(RefusalAfter(CleanTouches(),
                           [](std::size_t row, std::array<double, 4>* volts) {
                             if (row >= 100) (*volts)[1] /= 2;
                           }),
              AllOf(HasSubstr("log.csv row 10"),
                    HasSubstr("gauge_2_V responds 0.5 times as much")));
}

TEST(GaugeChangesTest, NamesTheRowOfExchangedChannels) {
  EXPECT_THAT(RefusalAfter(CleanTouches(),
                           [](std::size_t row, std::array<double, 4>* volts) {
                             if (row >= 120)
                               std::swap((*volts)[0], (*volts)[2]);
                           }),
              AllOf(HasSubstr("log.csv row 12"),
                    HasSubstr("gauge_1_V bends as gauge 3 should")));
}

TEST(GaugeChangesTest, NamesTheRowOfCoarserSteps) {
  const auto coarse = [](bool first, std::array<double, 4>* volts) {
    if (first) (*volts)[3] = 0.005 * std::round((*volts)[3] / 0.005);
  };
  EXPECT_THAT(
      RefusalAfter(CleanTouches(),
                   [&](std::size_t row, std::array<double, 4>* volts) {
                     coarse(row >= 130, volts);
                   }),
      AllOf(HasSubstr("gauge_4_V has steps of 0.005 V from log.csv row 13"),
            HasSubstr("finer ones before")));
  EXPECT_THAT(RefusalAfter(CleanTouches(),
                           [&](std::size_t row, std::array<double, 4>* volts) {
                             coarse(row < 80, volts);
                           }),
              HasSubstr("gauge_4_V has steps of 0.005 V before log.csv row 8"));
}

}  // namespace
}  // namespace finray
