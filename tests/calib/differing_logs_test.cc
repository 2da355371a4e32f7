// What differs from log to log, or changes in one, is named as that.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "calib/calibrated.h"
#include "calib/recovery.h"
#include "finray/calib/analysis/cross_validation.h"
#include "finray/calib/analysis/explore.h"
#include "finray/calib/analysis/refit.h"
#include "finray/calib/analysis/score_test.h"
#include "finray/calib/report/calibration_result.h"

namespace finray {
namespace {

using testing::HasSubstr;

Plan CommonOrigin() {
  Plan plan = StandardPlan();
  Free(ParameterFamily::kObjectOrigin, &plan).prior_std = 0.5;
  return plan;
}

ScoreTest ScoresAt(const Calibrated& at) {
  const WideLinearization wide = LinearizeWide(*at.problem, at.solution);
  const ScoreTest score = TestScores(*at.problem, at.found, wide);
  if (score.Best() == nullptr) return score;
  const SolvedProblem solved{at.problem.get(), nullptr, at.solution,
                             CrossValidatedLogLikelihood(*at.problem, wide)};
  return TestScores(*at.problem, at.found, wide, RefitRivals(solved, score));
}

// The stage is set up anew for each log.
TEST(DifferingLogsTest, OriginsOfTheStage) {
  const TempFolder folder;
  const double y_mm[] = {0.5, -0.4, 0.1};
  std::vector<std::string> logs;
  for (unsigned k = 0; k < 3; ++k) {
    FrameTable log =
        MakeLog(HiddenFinger(), StandardFrames(HiddenFinger(), 81 + k),
                {0.02, 0.05, 81 + k});
    for (double& y : log.MutableNumbers("object_y_mm")) y += y_mm[k];
    logs.push_back(
        folder.Path(std::string(1, static_cast<char>('a' + k)) + ".csv"));
    log.Write(logs.back());
  }
  const Calibrated at(CommonOrigin(), logs);
  const ScoreTest score = ScoresAt(at);
  ASSERT_NE(score.Best(), nullptr);
  EXPECT_EQ(score.Best()->family, ParameterFamily::kObjectOrigin)
      << score.Words();
  EXPECT_EQ(score.Best()->where, ScoreTest::Where::kByLog);
  EXPECT_THAT(score.Best()->words, HasSubstr("object_origin_y_mm["));

  const Finger start = Nominal();
  CalibrationProblem problem(start, CommonOrigin(),
                             ReadCalibrationLogs(logs, start, CommonOrigin()),
                             {}, 2);
  const Exploration found = Explore(&problem);
  EXPECT_TRUE(std::any_of(found.steps.begin(), found.steps.end(),
                          [](const Exploration::Step& step) {
                            return step.kept && step.effect.per_log &&
                                   step.effect.family ==
                                       ParameterFamily::kObjectOrigin;
                          }));
  EXPECT_TRUE(found.beyond.empty());
}

// Somebody tares the force sensor while the log runs.
TEST(DifferingLogsTest, AForceBiasThatChanges) {
  const FrameTable train =
      FrameTable::Read(FINRAY_SOURCE_DIR "/datasets/simulated_r15/train.csv");
  const Plan plan =
      ReadPlan(FINRAY_SOURCE_DIR "/configs/plans/force_and_circle.yaml");
  const auto problem = [&](const std::string& log) {
    return std::make_unique<CalibrationProblem>(
        PaperFinger(), plan, ReadCalibrationLogs({log}, PaperFinger(), plan),
        Discretization(), 2);
  };
  for (const auto& [from, bias_N] :
       {std::pair<std::size_t, double>{105, 0.15}, {105, 0.3}}) {
    const TempFolder folder;
    FrameTable log = train;
    for (std::size_t i = from; i < log.rows(); ++i) {
      log.MutableNumbers("force_N")[i] += bias_N;
    }
    log.Write(folder.Path("log.csv"));
    const auto solved = problem(folder.Path("log.csv"));
    const ScoreTest score = Calibrate(solved.get(), false).score;
    ASSERT_NE(score.Best(), nullptr);
    EXPECT_EQ(score.Best()->family, ParameterFamily::kForceOffset)
        << score.Words();
    EXPECT_EQ(score.Best()->where, ScoreTest::Where::kFrom);
    EXPECT_EQ(score.Best()->rows, " from log.csv row 106 on");
    const auto& value = score.Best()->values[0];
    EXPECT_NEAR(value.value, bias_N, 4 * value.std) << score.Words();

    const Exploration found = Explore(problem(folder.Path("log.csv")).get());
    EXPECT_TRUE(found.steps.empty());
    EXPECT_THAT(found.beyond, HasSubstr("an offset of the force sensor from"));
  }
}

// An offset changes several times. Each change alone leaves the others, so that
// --explore names none.
TEST(DifferingLogsTest, ExploreNamesNoCauseThatDoesNotExplain) {
  const Plan plan =
      ReadPlan(FINRAY_SOURCE_DIR "/configs/plans/force_and_circle.yaml");
  FrameTable log =
      FrameTable::Read(FINRAY_SOURCE_DIR "/datasets/simulated_r15/train.csv");
  for (std::size_t i = 0; i < log.rows(); ++i) {
    log.MutableNumbers("gauge_2_V")[i] +=
        0.004 * static_cast<double>(i / 50 % 3);
  }
  const TempFolder folder;
  log.Write(folder.Path("log.csv"));
  CalibrationProblem problem(
      PaperFinger(), plan,
      ReadCalibrationLogs({folder.Path("log.csv")}, PaperFinger(), plan), {},
      2);
  EXPECT_EQ(Explore(&problem).beyond,
            "no effect that finray knows explains the logs");
}

// Calibrates the paper's finger with a log.
CalibrationResult ResultOf(const FrameTable& log) {
  const TempFolder folder;
  log.Write(folder.Path("log.csv"));
  const Plan plan =
      ReadPlan(FINRAY_SOURCE_DIR "/configs/plans/force_and_circle.yaml");
  CalibrationProblem problem(
      PaperFinger(), plan,
      ReadCalibrationLogs({folder.Path("log.csv")}, PaperFinger(), plan), {},
      2);
  return Calibrate(&problem);
}

// Rows before a step of 30 mV, too small to be found before the solve, are
// rejected; the doubt names the row of the step.
TEST(DifferingLogsTest, AStepThatRejectsTheRowsBeforeItIsNamed) {
  FrameTable log =
      FrameTable::Read(FINRAY_SOURCE_DIR "/datasets/simulated_r15/train.csv");
  for (std::size_t i = 40; i < log.rows(); ++i) {
    for (const char* gauge : {"gauge_1_V", "gauge_2_V"}) {
      log.MutableNumbers(gauge)[i] += 0.03;
    }
  }
  EXPECT_THAT(ResultOf(log).doubts,
              testing::Contains(HasSubstr(
                  "early rows, nearly all up to row 40 of log.csv: something "
                  "changes there")));
}

// Where few enough rows are of another kind, they are outliers. They are not of
// the same rows as the others then, and that is a doubt.
TEST(DifferingLogsTest, RejectedRowsOfOneEndAreADoubt) {
  FrameTable log =
      FrameTable::Read(FINRAY_SOURCE_DIR "/datasets/simulated_r15/train.csv");
  for (std::size_t i = 160; i < log.rows(); ++i) {
    log.MutableNumbers("force_N")[i] += 0.3;
  }
  const CalibrationResult result = ResultOf(log);
  EXPECT_EQ(result.Verdict(), "doubtful");
  EXPECT_THAT(result.doubts, testing::Contains(HasSubstr("late rows")));
}

}  // namespace
}  // namespace finray
