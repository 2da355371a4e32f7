#include "finray/calib/problem/calibration_problem.h"

#include <gtest/gtest.h>

#include "calib/standard_log.h"
#include "finray/calib/analysis/identifiability.h"
#include "finray/calib/solve/robust_solve.h"

namespace finray {
namespace {

Plan PlanWithoutPriors() {
  Plan plan = StandardPlan();
  for (int i = 0; i < 5; ++i) plan.families[i].prior_std.reset();
  return plan;
}

struct Solved {
  std::vector<double> values, std;
};

Solved Solve(const std::vector<std::string>& logs, int threads) {
  const Plan plan = PlanWithoutPriors();
  CalibrationProblem problem(
      Nominal(), plan, ReadCalibrationLogs(logs, Nominal(), plan), {}, threads);
  const CalibrationSolution solution = SolveOnce(&problem);
  EXPECT_TRUE(solution.solve.converged);
  Solved solved;
  solved.std = AnalyzeIdentifiability(&problem, solution.at).std;
  for (const int i : problem.parameters().free()) {
    solved.values.push_back(*problem.parameters().all()[i].variable);
  }
  return solved;
}

// Every frame twice says the same, and no more surely.
TEST(CalibrationProblemTest, TheSameFramesTwice) {
  const TempFolder folders[3];
  std::vector<std::string> logs, twice;
  for (unsigned i = 0; i < 3; ++i) {
    logs.push_back(StandardLog(folders[i], HiddenFinger(), 20 + i));
  }
  twice = logs;
  twice.insert(twice.end(), logs.begin(), logs.end());
  const Solved few = Solve(logs, 2);
  const Solved many = Solve(twice, 2);
  ASSERT_EQ(few.values.size(), 15u);
  for (std::size_t i = 0; i < few.values.size(); ++i) {
    EXPECT_NEAR(many.values[i], few.values[i], 0.02 * many.std[i]) << i;
    EXPECT_NEAR(many.std[i], few.std[i], 1e-3 * few.std[i]);
  }
  const Solved one_thread = Solve(twice, 1);
  EXPECT_EQ(one_thread.values, many.values);
  EXPECT_EQ(one_thread.std, many.std);
}

}  // namespace
}  // namespace finray
