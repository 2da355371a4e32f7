// Hysteresis against logs in the order in which they were recorded: noise is
// none, and a loop is found with its width.

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "calib/calibrated.h"
#include "calib/recorded_log.h"
#include "calib/recovery.h"
#include "finray/calib/analysis/explore.h"
#include "finray/calib/analysis/score_test.h"
#include "finray/calib/report/calibration_result.h"

namespace finray {
namespace {

Plan PlanWithOrigin() {
  Plan plan = StandardPlan();
  Free(ParameterFamily::kObjectOrigin, &plan).prior_std = 0.5;
  return plan;
}

ScoreTest ScoresOf(const std::string& log, double noise_rad) {
  const Calibrated at(PlanWithOrigin(), {log}, WithNoise(Nominal(), noise_rad));
  return TestScores(*at.problem, at.found,
                    LinearizeWide(*at.problem, at.solution));
}

// The regressor of a test that is made of readings goes with their noise: of
// such logs nine in ten once had a loop of a negative width.
TEST(HysteresisTest, NoiseIsNone) {
  int named = 0;
  for (const double noise_rad : {3e-4, 6e-4, 1e-3}) {
    for (unsigned seed = 60; seed < 64; ++seed) {
      const TempFolder folder;
      const Finger truth = WithNoise(HiddenFinger(), noise_rad);
      const ScoreTest score =
          ScoresOf(RecordedLog(folder, truth, seed), noise_rad);
      named += score.Best() != nullptr;
      for (const ScoreTest::Effect& effect : score.effects) {
        if (effect.family != ParameterFamily::kGaugeHysteresis) continue;
        for (const ScoreTest::Value& value : effect.values) {
          EXPECT_GE(value.value, 0) << value.name;
        }
      }
    }
  }
  EXPECT_EQ(named, 0);
}

TEST(HysteresisTest, AWidthOfSomeNoiseIsNamed) {
  const double widths[] = {2e-3, 1.5e-3, 2.5e-3, 1.8e-3};
  Finger truth = WithNoise(HiddenFinger(), 6e-4);
  for (int j = 0; j < 4; ++j) truth.gauges[j].hysteresis_rad = widths[j];
  const TempFolder folder;
  const std::string log = RecordedLog(folder, truth, 71);
  const ScoreTest score = ScoresOf(log, 6e-4);
  ASSERT_NE(score.Best(), nullptr);
  EXPECT_EQ(score.Best()->family, ParameterFamily::kGaugeHysteresis)
      << score.Words();

  Plan plan = PlanWithOrigin();
  Free(ParameterFamily::kGaugeHysteresis, &plan).prior_std = 1e-3;
  const Recovery with(WithNoise(Nominal(), 6e-4), plan, {log});
  for (int j = 0; j < 4; ++j) {
    const std::string name =
        "gauge_" + std::to_string(j + 1) + "_hysteresis_rad";
    EXPECT_LT(std::abs(with.Value(name) - widths[j]), 3 * with.Std(name))
        << name << ": " << with.Value(name) << " +- " << with.Std(name);
    EXPECT_LT(with.Std(name), 2e-4);
  }
}

// A log by another simulator.
TEST(HysteresisTest, ACleanLogIsGood) {
  const std::string folder =
      FINRAY_SOURCE_DIR "/../shared/cases/hysteresis_false_alarm/";
  if (!std::filesystem::exists(folder + "cal.csv")) {
    GTEST_SKIP() << "without " << folder;
  }
  const Finger finger = ReadFinger(folder + "f.yaml");
  const Plan plan = ReadPlan(folder + "plan.yaml");
  CalibrationProblem problem(
      finger, plan, ReadCalibrationLogs({folder + "cal.csv"}, finger, plan), {},
      2);
  EXPECT_TRUE(Explore(&problem).steps.empty());
  CalibrationProblem again(
      finger, plan, ReadCalibrationLogs({folder + "cal.csv"}, finger, plan), {},
      2);
  EXPECT_EQ(Calibrate(&again, false).Verdict(), "good");
}

}  // namespace
}  // namespace finray
