#include "finray/calib/problem/row_times.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include "calib/standard_log.h"
#include "finray/calib/analysis/candidate_effects.h"
#include "finray/calib/analysis/explore.h"
#include "finray/calib/report/calibration_result.h"

namespace finray {
namespace {

using testing::HasSubstr;

TEST(RowTimesTest, CountsTiesAndSteps) {
  const RowTimes times =
      RowTimes::Of({0, 1, 1, std::nan(""), 1, 2, 1.5, 1.6, 0.2});
  EXPECT_EQ(times.ties, 2);
  EXPECT_EQ(times.first_tie, 3);
  EXPECT_EQ(times.backs, 2);
  EXPECT_EQ(times.first_back, 7);
}

TEST(RowTimesTest, SayWhatCanBeFree) {
  CalibrationLogs logs;
  logs.times = {RowTimes(), {5, 3, 0, 0}};
  EXPECT_FALSE(TimesAllow(ParameterFamily::kForceTimeOffset, logs));
  EXPECT_FALSE(TimesAllow(ParameterFamily::kGaugeCreepShare, logs));
  EXPECT_TRUE(TimesAllow(ParameterFamily::kGaugeDrift, logs));
  EXPECT_TRUE(TimesAllow(ParameterFamily::kGaugeHysteresis, logs));
  logs.times[1] = {0, 0, 1, 9};
  EXPECT_FALSE(TimesAllow(ParameterFamily::kGaugeDrift, logs));
  EXPECT_FALSE(TimesAllow(ParameterFamily::kGaugeHysteresis, logs));
  EXPECT_TRUE(TimesAllow(ParameterFamily::kForceScale, logs));
}

struct Calibration {
  CalibrationResult result;
  std::vector<double> values;
  std::size_t explored;
};

Calibration CalibrationOf(const FrameTable& log) {
  const TempFolder folder;
  log.Write(folder.Path("train.csv"));
  const Finger finger = PaperFinger();
  const Plan plan =
      ReadPlan(FINRAY_SOURCE_DIR "/configs/plans/force_and_circle.yaml");
  const auto problem = [&] {
    return std::make_unique<CalibrationProblem>(
        finger, plan,
        ReadCalibrationLogs({folder.Path("train.csv")}, finger, plan),
        Discretization(), 2);
  };
  const auto solved = problem(), explored = problem();
  Calibration calibration{Calibrate(solved.get(), false), {}, 0};
  const Eigen::VectorXd values = solved->Values();
  calibration.values.assign(values.begin(), values.end());
  calibration.explored = Explore(explored.get()).steps.size();
  return calibration;
}

// No row's force may depend on the times of rows.
TEST(RowTimesTest, LeaveTheForceAlone) {
  const FrameTable log =
      FrameTable::Read(FINRAY_SOURCE_DIR "/datasets/simulated_r15/train.csv");
  const Calibration as_it_is = CalibrationOf(log);
  EXPECT_EQ(as_it_is.result.Verdict(), "good");
  const std::size_t rows = log.rows();
  std::vector<double> shuffled = log.Numbers("time_s");
  std::shuffle(shuffled.begin(), shuffled.end(), std::mt19937_64(3));
  const std::pair<std::function<double(std::size_t)>, const char*> clocks[] = {
      {[](std::size_t i) { return std::floor(0.1 * static_cast<double>(i)); },
       "it is that of the row before, first in train.csv row 2"},
      {[](std::size_t) { return 0.0; },
       "209 times it is that of the row before"},
      {[&](std::size_t i) { return shuffled[i]; }, "times it goes back"},
      {[&](std::size_t i) { return 0.1 * static_cast<double>(i % (rows / 2)); },
       "1 times it goes back, first in train.csv row 106"},
      {[](std::size_t i) { return 1.7e9 + 0.1 * static_cast<double>(i); }, ""}};
  for (const auto& [clock, words] : clocks) {
    FrameTable other = log;
    for (std::size_t i = 0; i < rows; ++i) {
      other.MutableNumbers("time_s")[i] = clock(i);
    }
    const Calibration with = CalibrationOf(other);
    EXPECT_EQ(with.result.Verdict(), "good") << words;
    EXPECT_EQ(with.explored, 0u) << words;
    for (std::size_t k = 0; k < with.values.size(); ++k) {
      EXPECT_NEAR(with.values[k], as_it_is.values[k],
                  1e-9 * std::abs(as_it_is.values[k]));
    }
    std::vector<std::string> said;
    for (const Warning& warning : with.result.warnings) {
      if (warning.code == "times_do_not_rise") said.push_back(warning.text);
    }
    ASSERT_EQ(said.size(), *words == '\0' ? 0u : 1u);
    for (const std::string& text : said) EXPECT_THAT(text, HasSubstr(words));
  }
}

TEST(RowTimesTest, WhatThePlanFreesInVainIsSaid) {
  FrameTable log =
      FrameTable::Read(FINRAY_SOURCE_DIR "/datasets/simulated_r15/train.csv");
  for (double& time_s : log.MutableNumbers("time_s")) time_s = 7;
  const TempFolder folder;
  log.Write(folder.Path("train.csv"));
  const Finger finger = PaperFinger();
  Plan plan =
      ReadPlan(FINRAY_SOURCE_DIR "/configs/plans/force_and_circle.yaml");
  plan.families[static_cast<int>(ParameterFamily::kForceTimeOffset)] = {
      true, 0.1, false};
  CalibrationProblem problem(
      finger, plan,
      ReadCalibrationLogs({folder.Path("train.csv")}, finger, plan), {}, 2);
  EXPECT_FALSE(problem.plan().family(ParameterFamily::kForceTimeOffset).free);
  const CalibrationResult result = Calibrate(&problem, false);
  const auto said = std::find_if(
      result.warnings.begin(), result.warnings.end(),
      [](const Warning& w) { return w.code == "times_do_not_rise"; });
  ASSERT_NE(said, result.warnings.end());
  EXPECT_THAT(said->text,
              HasSubstr("force_time_offset of the plan stays fixed"));
}

}  // namespace
}  // namespace finray
