#include "finray/calib/analysis/cross_validation.h"

#include <gtest/gtest.h>

#include <cmath>

#include "calib/calibrated.h"
#include "finray/calib/analysis/discrepancy.h"
#include "finray/calib/solve/summed_solve.h"

namespace finray {
namespace {

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

TEST(CrossValidationTest, IntervalsOfACleanLogHold) {
  const TempFolder folder;
  Calibrated all(StandardPlan(), {StandardLog(folder, HiddenFinger(), 62)});
  const CrossValidation found = CrossValidate(
      *all.problem, all.found, LinearizeWide(*all.problem, all.solution));
  EXPECT_EQ(found.folds, WideLinearization::kFolds);
  const ErrorStatistics& forces = found.errors.contact.force_N;
  EXPECT_GT(forces.judged, 180u);
  EXPECT_NEAR(forces.coverage_68_percent(), 68, 12);
  EXPECT_NEAR(forces.coverage_95_percent(), 95, 5);
}

TEST(CrossValidationTest, ThreadsDoNotChangeTheResult) {
  const TempFolder folder;
  Calibrated all(StandardPlan(), {StandardLog(folder, HiddenFinger(), 63)});
  const WideLinearization wide = LinearizeWide(*all.problem, all.solution);
  CrossValidation checked[2];
  HeldOutErrors errors[2];
  for (const int threads : {1, 3}) {
    const auto problem = all.problem->Part(all.solution.at.frames, threads);
    checked[threads / 2] = CrossValidate(*problem, all.found, wide);
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
