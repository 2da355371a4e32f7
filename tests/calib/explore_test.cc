#include "finray/calib/analysis/explore.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "calib/turned_stage.h"
#include "finray/calib/report/calibration_result.h"
#include "finray/finger/finger_yaml.h"

namespace finray {
namespace {

CalibrationProblem ProblemOf(const Plan& plan, const std::string& log) {
  return CalibrationProblem(Nominal(), plan,
                            ReadCalibrationLogs({log}, Nominal(), plan), {}, 2);
}

Plan Explored(Plan plan, const Exploration& found) {
  for (const Exploration::Step& step : found.steps) {
    if (step.kept) plan = Freed(plan, step.effect);
  }
  return plan;
}

TEST(ExploreTest, ATurnedStageIsFreedAndNothingElse) {
  const TempFolder folder;
  const std::string log = TurnedStageLog(folder, 71, 1);
  CalibrationProblem problem = ProblemOf(StandardPlan(), log);
  const Exploration found = Explore(&problem);
  ASSERT_FALSE(found.steps.empty());
  int kept = 0;
  for (const auto& step : found.steps) {
    kept += step.kept;
    EXPECT_TRUE(!step.kept || step.after > step.before);
  }
  EXPECT_EQ(kept, 1);
  const Plan plan = Explored(StandardPlan(), found);
  EXPECT_TRUE(plan.family(ParameterFamily::kObjectRotation).free);
  CalibrationProblem freed = ProblemOf(plan, log);
  EXPECT_EQ(Calibrate(&freed).Verdict(), "good");
}

TEST(ExploreTest, ACleanLogFreesNothing) {
  const TempFolder folder;
  CalibrationProblem problem =
      ProblemOf(StandardPlan(), StandardLog(folder, HiddenFinger(), 72));
  EXPECT_TRUE(Explore(&problem).steps.empty());
}

// A strip that CalculiX bends, on an object with friction of 0.3.
TEST(ExploreTest, FrictionOfAnotherPhysicsIsFound) {
  const std::string strip = FINRAY_SOURCE_DIR "/datasets/reality/strip/";
  const Finger drawn = ReadFinger(strip + "finger.yaml");
  const Plan plan = ReadPlan(strip + "plan_thickness.yaml");
  const auto calibrated = [&](const Plan& with, Exploration* explored) {
    CalibrationProblem problem(
        drawn, with,
        ReadCalibrationLogs({strip + "rough/train.csv"}, drawn, with), {}, 2);
    if (explored != nullptr) *explored = Explore(&problem);
    return Calibrate(&problem);
  };
  Exploration found;
  const CalibrationResult without = calibrated(plan, &found);
  EXPECT_EQ(without.Verdict(), "doubtful");
  ASSERT_FALSE(found.steps.empty());
  EXPECT_EQ(found.steps[0].effect.family, ParameterFamily::kFriction);
  EXPECT_TRUE(found.steps[0].kept);
  const CalibrationResult with = calibrated(Explored(plan, found), nullptr);
  const auto covered = [](const CalibrationResult& result) {
    return result.cross_validation.errors.contact.force_N.coverage_95_percent();
  };
  EXPECT_GT(covered(with), std::max(90.0, covered(without)));
}

TEST(ExploreTest, ThePlanIsValidAnywhere) {
  const TempFolder folder;
  std::ofstream(folder.Path("scene.yaml"))
      << "object: {shape: circle, radius_mm: 15}\n";
  std::ofstream(folder.Path("plan.yaml"))
      << "schema_version: 1\nscene: scene.yaml\nparameters:\n"
         "  gauge_gain: {}\n  object_rotation: {fixed: true}\n";
  Exploration found;
  found.steps.push_back(
      {CandidateOf(ParameterFamily::kObjectRotation), "", 1, 2, 3, true});
  found.steps.push_back(
      {CandidateOf(ParameterFamily::kObjectRadius), "", 1, 2, 1, false});
  const TempFolder elsewhere;
  std::ofstream(elsewhere.Path("plan.yaml")) << ExploredPlanYaml(
      folder.Path("plan.yaml"), folder.Read("plan.yaml"), found);
  const Plan plan = ReadPlan(elsewhere.Path("plan.yaml"));
  EXPECT_EQ(plan.scene.circle_radius_mm(), 15);
  EXPECT_TRUE(plan.family(ParameterFamily::kGaugeGain).free);
  EXPECT_TRUE(plan.family(ParameterFamily::kObjectRotation).free);
  EXPECT_EQ(plan.family(ParameterFamily::kObjectRotation).prior_std, 1);
  EXPECT_FALSE(plan.family(ParameterFamily::kObjectRadius).free);
}

}  // namespace
}  // namespace finray
