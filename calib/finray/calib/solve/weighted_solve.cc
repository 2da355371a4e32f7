#include "finray/calib/solve/weighted_solve.h"

#include "finray/calib/solve/joint_problem.h"

namespace finray {
namespace {

constexpr double kRisingWeights[] = {1e3, 1e4, 1e5, 1e6};

}  // namespace

SolveReport SolveJointlyWeighted(const std::vector<int>& frames,
                                 const JointLimits& limits,
                                 CalibrationProblem* problem,
                                 ContactStore* contacts) {
  contacts->Guess(frames, ContactGuess::From::kObjectFirst);
  JointProblem joint(frames, EquilibriumForm::kWeighted, problem, contacts);
  SolveReport report;
  report.message = "a frame has no equilibrium to start from";
  for (const double weight : kRisingWeights) {
    if (!joint.ready()) return report;
    joint.set_weight(weight);
    const int before = report.iterations;
    report = joint.Solve(limits);
    report.iterations += before;
  }
  return report;
}

}  // namespace finray
