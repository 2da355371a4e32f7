#include "finray/calib/solve/joint_solve.h"

#include <algorithm>

#include "finray/calib/solve/joint_problem.h"

namespace finray {

SolveReport ReportOf(const ceres::Solver::Summary& summary) {
  return {summary.termination_type == ceres::CONVERGENCE ||
              summary.termination_type == ceres::USER_SUCCESS,
          std::max(0, static_cast<int>(summary.iterations.size()) - 1),
          summary.initial_cost, summary.final_cost, summary.message};
}

SolveReport SolveJointly(const std::vector<int>& frames,
                         const JointLimits& limits, CalibrationProblem* problem,
                         ContactStore* contacts) {
  contacts->Guess(frames, ContactGuess::From::kObjectFirst);
  return JointProblem(frames, EquilibriumForm::kReduced, problem, contacts)
      .Solve(limits);
}

}  // namespace finray
