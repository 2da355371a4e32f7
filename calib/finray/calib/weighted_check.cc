#include "finray/calib/weighted_check.h"

#include <algorithm>
#include <cmath>

#include "finray/calib/identifiability.h"

namespace finray {
namespace {

// The priors' information, of the free parameters.
Eigen::MatrixXd PriorInformation(const CalibrationParameters& parameters) {
  const auto n = static_cast<Eigen::Index>(parameters.free().size());
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index k = 0; k < n; ++k) {
    const CalibrationParameter& p =
        parameters.all()[parameters.free()[static_cast<std::size_t>(k)]];
    if (p.prior_std) information(k, k) = 1 / (*p.prior_std * *p.prior_std);
  }
  return information;
}

Eigen::VectorXd Std(const Eigen::MatrixXd& information,
                    const Eigen::VectorXd& unit) {
  const Eigen::MatrixXd covariance =
      BoundedCovariance(unit.asDiagonal() * information * unit.asDiagonal());
  return covariance.diagonal().cwiseSqrt().cwiseProduct(unit);
}

}  // namespace

WeightedCheck CheckWeighted(CalibrationProblem* problem) {
  const CalibrationProblem::Point before = problem->Save();
  WeightedCheck check;
  check.reduced = problem->SolveSomeOn();
  const Eigen::MatrixXd reduced = problem->InformationOfSome();
  const CalibrationProblem::Point at_reduced = problem->Save();
  Eigen::MatrixXd weighted;
  check.weighted = problem->SolveSomeWeighted(&weighted);
  check.frames = static_cast<int>(problem->SomeFrames().size());
  weighted += PriorInformation(problem->parameters());
  const Eigen::VectorXd at_weighted = problem->Save().values;
  problem->Restore(before);

  const Eigen::VectorXd unit = problem->parameters().Units();
  const Eigen::VectorXd std = Std(reduced, unit);
  const Eigen::VectorXd std_weighted = Std(weighted, unit);
  for (Eigen::Index k = 0; k < unit.size(); ++k) {
    if (std[k] > 0.1 * unit[k] / Identifiability::kNull) continue;
    check.value_difference_std =
        std::max(check.value_difference_std,
                 std::abs(at_weighted[k] - at_reduced.values[k]) / std[k]);
    check.std_difference =
        std::max(check.std_difference, std::abs(std_weighted[k] / std[k] - 1));
  }
  return check;
}

}  // namespace finray
