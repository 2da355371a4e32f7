#include "finray/calib/analysis/cross_validation.h"

#include <gtest/gtest.h>

#include <cmath>

#include "calib/calibrated.h"
#include "finray/calib/analysis/discrepancy.h"
#include "finray/calib/analysis/validation.h"
#include "finray/calib/solve/summed_solve.h"

namespace finray {
namespace {

std::unique_ptr<const FrameEstimator> EstimatorOf(Calibrated* all) {
  Finger solved = all->problem->parameters().Apply(all->problem->finger());
  KeepCovariance(all->problem->parameters(), all->found, &solved);
  return SensingEstimator(*all->problem, solved);
}

TEST(CrossValidationTest, OneStepFindsWhatASolveOfTheRestFinds) {
  const TempFolder folder;
  Calibrated all(StandardPlan(), {StandardLog(folder, HiddenFinger(), 61)});
  const WideLinearization wide = LinearizeWide(*all.problem, all.solution);
  const LeftOut left = LeaveFoldOut(*all.problem, wide, 2);
  std::vector<int> rest;
  for (int fold = 0; fold < WideLinearization::kFolds; ++fold) {
    if (fold == 2) continue;
    rest.insert(rest.end(), wide.frames[fold].begin(), wide.frames[fold].end());
  }
  const auto part = all.problem->Part(rest, 2);
  ContactStore contacts(part.get());
  contacts.Set(all.solution.contacts);
  ASSERT_TRUE(SolveSummed(rest, {}, part.get(), &contacts).report.converged);
  const Eigen::VectorXd moved = part->Values() - all.problem->Values();
  double largest = 0;
  for (Eigen::Index k = 0; k < moved.size(); ++k) {
    EXPECT_NEAR(left.values[k], part->Values()[k], 0.1 * all.found.std[k]);
    largest = std::max(largest, std::abs(moved[k]) / all.found.std[k]);
  }
  EXPECT_GT(largest, 0.3);  // there was something to find
}

TEST(CrossValidationTest, OneEstimatorServesAllFolds) {
  const TempFolder folder;
  Calibrated all(StandardPlan(), {StandardLog(folder, HiddenFinger(), 62)});
  const WideLinearization wide = LinearizeWide(*all.problem, all.solution);
  const CrossValidation found =
      CrossValidate(*all.problem, all.found, wide, EstimatorOf(&all).get());
  // With an estimator for each fold.
  ErrorTable exact;
  exact.front_length_mm = all.problem->finger().front_length_mm;
  for (int fold = 0; fold < WideLinearization::kFolds; ++fold) {
    const std::vector<int>& frames = wide.checked[fold];
    LeftOutFinger without(*all.problem, all.found,
                          LeaveFoldOut(*all.problem, wide, fold), frames);
    CalibrationProblem* part = without.part.get();
    const SensedFrames sensed = {
        ReferencesAt(part, without.finger, frames, nullptr),
        EstimateReadings(SensingEstimator(*part, without.finger).get(),
                         SensedReadings(part, without.finger, frames), 1)};
    for (std::size_t k = 0; k < frames.size(); ++k) sensed.AddTo(&exact, k, 0);
  }
  const ErrorStatistics& forces = found.errors.contact.force_N;
  EXPECT_EQ(forces.judged, exact.contact.force_N.judged);
  EXPECT_NEAR(forces.rms(), exact.contact.force_N.rms(),
              1e-2 * exact.contact.force_N.rms());
  EXPECT_NEAR(forces.rms_z(), exact.contact.force_N.rms_z(), 0.02);
}

TEST(CrossValidationTest, IntervalsOfACleanLogHold) {
  const TempFolder folder;
  Calibrated all(StandardPlan(), {StandardLog(folder, HiddenFinger(), 62)});
  const CrossValidation found = CrossValidate(
      *all.problem, all.found, LinearizeWide(*all.problem, all.solution),
      EstimatorOf(&all).get());
  EXPECT_EQ(found.folds, WideLinearization::kFolds);
  const ErrorStatistics& forces = found.errors.contact.force_N;
  EXPECT_GT(forces.judged, 180u);
  EXPECT_NEAR(forces.coverage_68_percent(), 68, 12);
  EXPECT_NEAR(forces.coverage_95_percent(), 95, 5);
}

// Candidates add columns; what the free parameters predict stays the same.
TEST(CrossValidationTest, FoldsNeedFewCandidates) {
  const TempFolder folder;
  Calibrated all(StandardPlan(), {StandardLog(folder, HiddenFinger(), 63)});
  const WideLinearization wide = LinearizeWide(*all.problem, all.solution);
  const WideLinearization folds = LinearizeFolds(*all.problem, all.solution);
  EXPECT_GT(wide.candidates.size(), 10u);
  EXPECT_LT(folds.candidates.size(), 3u);
  EXPECT_NEAR(CrossValidatedLogLikelihood(*all.problem, folds),
              CrossValidatedLogLikelihood(*all.problem, wide), 1e-6);
}

TEST(CrossValidationTest, ThreadsDoNotChangeTheResult) {
  const TempFolder folder;
  Calibrated all(StandardPlan(), {StandardLog(folder, HiddenFinger(), 63)});
  const WideLinearization wide = LinearizeWide(*all.problem, all.solution);
  const auto estimator = EstimatorOf(&all);
  CrossValidation checked[2];
  HeldOutErrors errors[2];
  for (const int threads : {1, 3}) {
    const auto problem = all.problem->Part(all.solution.at.frames, threads);
    checked[threads / 2] =
        CrossValidate(*problem, all.found, wide, estimator.get());
    errors[threads / 2] =
        GaugeErrorsOf(*problem, all.solution, all.found, wide);
  }
  EXPECT_EQ(checked[0].folds, WideLinearization::kFolds);
  EXPECT_EQ(checked[1].folds, WideLinearization::kFolds);
  EXPECT_EQ(checked[0].errors.contact.force_N.rms(),
            checked[1].errors.contact.force_N.rms());
  ASSERT_EQ(errors[0].fitted.size(), errors[1].fitted.size());
  EXPECT_GT(errors[0].fitted.size(), 100u);
  for (std::size_t i = 0; i < errors[0].fitted.size(); ++i) {
    EXPECT_EQ(errors[0].fitted[i].error_rad, errors[1].fitted[i].error_rad);
  }
}

}  // namespace
}  // namespace finray
