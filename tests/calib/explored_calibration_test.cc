#include "finray/calib/report/explored_calibration.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <stdexcept>
#include <string>

#include "calib/turned_stage.h"

namespace finray {
namespace {

using testing::HasSubstr;
using testing::Not;

std::unique_ptr<CalibrationProblem> ProblemBy(const Plan& plan,
                                              const std::string& log) {
  return std::make_unique<CalibrationProblem>(
      Nominal(), plan, ReadCalibrationLogs({log}, Nominal(), plan),
      Discretization(), 2);
}

std::string WarningOf(const CalibrationResult& result,
                      const std::string& code) {
  std::string words;
  for (const Warning& warning : result.warnings) {
    if (warning.code == code) words += warning.text + "\n";
  }
  return words;
}

constexpr char kPlanText[] =
    "schema_version: 1\n"
    "scene: {object: {shape: circle, radius_mm: 15}}\n"
    "parameters:\n"
    "  front_stiffness: {prior_std_percent: 50}\n"
    "  back_stiffness: {prior_std_percent: 50}\n"
    "  gauge_gain: {prior_std_percent: 200}\n"
    "  gauge_offset: {prior_std_V: 1}\n"
    "  rib_length: {prior_std_mm: 0.5}\n";

class ExploredCalibrationTest : public testing::Test {
 protected:
  // Explores the log of a turned stage. `fail` says whether a step of the k-th
  // problem fails.
  template <class Fail>
  ExploredCalibration Explored(const Fail& fail) {
    int problems = 0;
    const Plan given = ReadPlan(YamlMap::FromText(kPlanText, "plan.yaml"));
    return CalibrateExplored(
        given, "plan.yaml", kPlanText,
        [&](const Plan& plan) {
          auto problem = ProblemBy(plan, log_);
          problem->TellProgress([fail, k = problems++](const std::string& at) {
            if (fail(k, at)) throw std::runtime_error("it cannot be");
          });
          return problem;
        },
        false);
  }

  const TempFolder folder_;
  const std::string log_ = TurnedStageLog(folder_, 71, 1);
};

TEST_F(ExploredCalibrationTest, FreesWhatTheLogShows) {
  const ExploredCalibration done =
      Explored([](int, const std::string&) { return false; });
  EXPECT_EQ(done.result.Verdict(), "good");
  EXPECT_TRUE(
      done.problem->plan().family(ParameterFamily::kObjectRotation).free);
}

// The calibration by the explored plan fails; that by the given one is written.
TEST_F(ExploredCalibrationTest, ACalibrationThatFailsIsDoneWithoutTheEffect) {
  const ExploredCalibration done =
      Explored([](int problem, const std::string&) { return problem == 1; });
  EXPECT_NE(done.result.Verdict(), "not_converged");
  EXPECT_FALSE(
      done.problem->plan().family(ParameterFamily::kObjectRotation).free);
  EXPECT_THAT(WarningOf(done.result, "explore_step_failed"),
              HasSubstr("calibration with object_rotation free: it cannot be"));
  EXPECT_THAT(done.plan_yaml, Not(HasSubstr("\n  object_rotation:")));
}

TEST_F(ExploredCalibrationTest, RefitsThatFailStayFixed) {
  bool searching = false;
  const ExploredCalibration done =
      Explored([&](int problem, const std::string& step) {
        searching |= step == "effects that the plan leaves out";
        return problem == 0 && searching &&
               step.find("frames, step") != std::string::npos;
      });
  EXPECT_EQ(done.result.Verdict(), "doubtful");
  EXPECT_THAT(WarningOf(done.result, "explore_step_failed"),
              HasSubstr("refit with object_rotation free: it cannot be"));
}

TEST_F(ExploredCalibrationTest, ASearchThatFailsEndsThere) {
  int searches = 0;
  const ExploredCalibration done =
      Explored([&](int problem, const std::string& step) {
        return problem == 0 && step == "effects that the plan leaves out" &&
               ++searches == 2;
      });
  EXPECT_EQ(done.result.Verdict(), "good");
  EXPECT_THAT(WarningOf(done.result, "explore_step_failed"),
              HasSubstr("search for effects after object_rotation"));
}

// Nothing stands without a solve.
TEST_F(ExploredCalibrationTest, AFirstSolveThatFailsThrows) {
  EXPECT_THROW(Explored([](int, const std::string&) { return true; }),
               std::runtime_error);
}

// A test that is not made shows nothing, so the result is not good.
TEST(CalibrateTest, OptionalStepsMayFail) {
  const TempFolder folder;
  const std::string log = StandardLog(folder, HiddenFinger(), 72);
  for (const auto& [failing, is_test] :
       {std::pair("what to record next", false),
        std::pair("effects that the plan leaves out", true),
        std::pair("check of forces and contacts", true)}) {
    const auto problem = ProblemBy(StandardPlan(), log);
    problem->TellProgress([step = std::string(failing)](const std::string& at) {
      if (at == step) throw std::runtime_error("it cannot be");
    });
    const CalibrationResult result = Calibrate(problem.get());
    EXPECT_TRUE(result.solution.solve.converged);
    EXPECT_THAT(WarningOf(result, "step_failed"),
                HasSubstr(std::string(failing) + ": it cannot be"));
    EXPECT_EQ(result.Verdict(), is_test ? "doubtful" : "good") << failing;
  }
}

}  // namespace
}  // namespace finray
