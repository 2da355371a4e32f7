#include "finray/calib/report/explored_calibration.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "finray/calib/report/doubts.h"

namespace finray {
namespace {

struct ProblemAndResult {
  std::unique_ptr<CalibrationProblem> problem;
  CalibrationResult result;
};

ProblemAndResult CalibratePlan(const Plan& plan,
                               const ProblemOfPlan& problem_of,
                               bool leave_logs_out) {
  ProblemAndResult done;
  done.problem = problem_of(plan);
  done.result = Calibrate(done.problem.get(), leave_logs_out);
  return done;
}

}  // namespace

ExploredCalibration CalibrateExplored(const Plan& given,
                                      const std::string& path,
                                      const std::string& text,
                                      const ProblemOfPlan& problem_of,
                                      bool leave_logs_out) {
  ExploredCalibration explored;
  Exploration& found = explored.exploration;
  found = Explore(problem_of(given).get());
  ProblemAndResult done;
  for (;;) {
    explored.plan_yaml = ExploredPlanYaml(path, text, found);
    std::string why;
    try {
      done =
          CalibratePlan(ReadPlan(YamlMap::FromText(explored.plan_yaml, path)),
                        problem_of, leave_logs_out);
      const SolveReport& solve = done.result.solution.solve;
      if (solve.converged) break;
      why = "the solver stopped early: " + solve.message;
    } catch (const std::runtime_error& error) {
      if (!FixLast(error.what(), &found)) throw;
      continue;
    }
    if (!FixLast(why, &found)) break;
  }
  const auto freed = [](const Exploration::Step& step) { return step.kept; };
  const bool any = std::any_of(found.steps.begin(), found.steps.end(), freed);
  std::string why_not, not_compared;
  if (any && done.result.Verdict() != "good") {
    try {
      ProblemAndResult as_given =
          CalibratePlan(given, problem_of, leave_logs_out);
      why_not = WhyNotAdopted(done.result, as_given.result);
      explored.as_given = !why_not.empty();
      if (explored.as_given) done = std::move(as_given);
    } catch (const std::runtime_error& error) {
      not_compared = error.what();
    }
  }
  explored.problem = std::move(done.problem);
  explored.result = std::move(done.result);
  if (explored.as_given) {
    explored.result.warnings.push_back(
        {"explored_not_adopted",
         "the result is that of the given plan: " + why_not,
         "look for what the logs have and finray lacks; plan.yaml has the "
         "freed effects"});
  }
  for (const std::string& failed : found.failed) {
    explored.result.warnings.push_back(
        {"explore_step_failed", "--explore: " + failed,
         "the result is what was solved without that step; free the effect in "
         "the plan, with a prior, if you know that it is there"});
  }
  if (!not_compared.empty()) {
    explored.result.warnings.push_back(
        {"explore_step_failed",
         "--explore: calibration by the given plan, to compare: " +
             not_compared,
         "the result has the freed effects, and nothing says whether the given "
         "plan does better: check them against what you know of the setup"});
  }
  return explored;
}

}  // namespace finray
