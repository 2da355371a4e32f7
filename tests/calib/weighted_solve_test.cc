#include "finray/calib/solve/weighted_solve.h"

#include <gtest/gtest.h>

#include "calib/standard_log.h"
#include "finray/calib/analysis/identifiability.h"
#include "finray/calib/solve/summed_solve.h"

namespace finray {
namespace {

// Both forms hold the same equilibrium, so they find the same finger.
TEST(WeightedSolveTest, EqualsTheReducedForm) {
  const TempFolder folder;
  MakeLog(HiddenFinger(), StandardFrames(HiddenFinger(), 1), {0.02, 0.05, 1})
      .Write(folder.Path("log.csv"));
  const Finger start = PaperFinger();
  const Plan plan =
      ReadPlan(FINRAY_SOURCE_DIR "/configs/plans/force_and_circle.yaml");
  CalibrationProblem whole(
      start, plan, ReadCalibrationLogs({folder.Path("log.csv")}, start, plan),
      {}, 1);
  std::vector<int> frames;  // one of them is free
  for (int i = 0; i < 210; i += 14) frames.push_back(i);
  constexpr JointLimits kLimits{200, 1e-14};
  const auto reduced = whole.Part(frames, 1), weighted = whole.Part(frames, 1);
  ContactStore contacts(reduced.get()), weighted_contacts(weighted.get());
  ASSERT_TRUE(
      SolveJointly(frames, kLimits, reduced.get(), &contacts).converged);
  const SolveReport report =
      SolveJointlyWeighted(frames, kLimits, weighted.get(), &weighted_contacts);
  ASSERT_TRUE(report.converged) << report.message;
  const auto at = FitFrames(frames, reduced.get(), &contacts);
  ASSERT_TRUE(at);
  const std::vector<double> found =
      AnalyzeIdentifiability(reduced.get(), *at).std;
  const Eigen::VectorXd apart = weighted->Values() - reduced->Values();
  for (std::size_t k = 0; k < found.size(); ++k) {
    EXPECT_LT(std::abs(apart[static_cast<Eigen::Index>(k)]), 0.01 * found[k]);
  }
  for (const int i : frames) {
    if (!whole.frame(i).contact) continue;
    EXPECT_NEAR(weighted_contacts[i][0], contacts[i][0], 0.01);
    EXPECT_NEAR(weighted_contacts[i][1], contacts[i][1], 1e-3);
  }
}

}  // namespace
}  // namespace finray
