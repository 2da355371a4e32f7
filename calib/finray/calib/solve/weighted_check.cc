#include "finray/calib/solve/weighted_check.h"

#include <algorithm>
#include <cmath>

#include "finray/calib/analysis/identifiability.h"

namespace finray {
namespace {

Eigen::VectorXd Std(const Eigen::MatrixXd& information,
                    const Eigen::VectorXd& unit) {
  const Eigen::MatrixXd covariance =
      BoundedCovariance(unit.asDiagonal() * information * unit.asDiagonal());
  return covariance.diagonal().cwiseSqrt().cwiseProduct(unit);
}

}  // namespace

WeightedCheck CheckWeighted(const CalibrationProblem& problem) {
  const std::vector<int> frames = problem.SomeFrames();
  const std::unique_ptr<CalibrationProblem> some = problem.Part(frames);
  const CalibrationParameters& parameters = some->parameters();
  const SolveReport reduced = some->SolveOn();
  Eigen::MatrixXd information = some->AtSolution().Information();
  information.diagonal() += parameters.PriorInformation();
  const Eigen::VectorXd values = some->Save().values;
  Eigen::MatrixXd information_weighted;
  const SolveReport weighted = some->SolveWeighted(&information_weighted);
  const Eigen::VectorXd values_weighted = some->Save().values;

  WeightedCheck check;
  check.frames = static_cast<int>(frames.size());
  check.converged = reduced.converged && weighted.converged;
  check.iterations = weighted.iterations;
  const Eigen::VectorXd unit = parameters.Units();
  const Eigen::VectorXd std = Std(information, unit);
  const Eigen::VectorXd std_weighted = Std(information_weighted, unit);
  for (Eigen::Index k = 0; k < unit.size(); ++k) {
    if (std[k] > 0.1 * unit[k] / Identifiability::kNull) continue;
    check.value_difference_std =
        std::max(check.value_difference_std,
                 std::abs(values_weighted[k] - values[k]) / std[k]);
    check.std_difference =
        std::max(check.std_difference, std::abs(std_weighted[k] / std[k] - 1));
  }
  return check;
}

}  // namespace finray
