#include "finray/calib/identifiability.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "finray/calib/weak_direction_words.h"

namespace finray {

const char* ParameterStatusName(ParameterStatus status) {
  constexpr const char* kNames[] = {"estimated", "prior_dominated",
                                    "unidentifiable", "fixed"};
  return kNames[static_cast<int>(status)];
}

Eigen::MatrixXd BoundedCovariance(const Eigen::MatrixXd& information) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(information);
  const Eigen::VectorXd bounded = eigen.eigenvalues().cwiseMax(
      Identifiability::kNull * Identifiability::kNull);
  return eigen.eigenvectors() * bounded.cwiseInverse().asDiagonal() *
         eigen.eigenvectors().transpose();
}

Identifiability AnalyzeIdentifiability(CalibrationProblem* problem) {
  const Linearization& at = problem->AtSolution();
  const CalibrationParameters& parameters = problem->parameters();
  const int n = static_cast<int>(parameters.free().size());

  Eigen::VectorXd unit(n);
  Eigen::MatrixXd prior = Eigen::MatrixXd::Zero(n, n);  // in those units
  for (int i = 0; i < n; ++i) {
    const CalibrationParameter& p = parameters.all()[parameters.free()[i]];
    unit[i] = p.prior_std.value_or(p.scale);
    if (p.prior_std) prior(i, i) = 1;
  }
  const auto scaled = [&](const Eigen::MatrixXd& of_variables) {
    return Eigen::MatrixXd(unit.asDiagonal() * of_variables *
                           unit.asDiagonal());
  };
  const Eigen::MatrixXd information = scaled(at.Information());

  Identifiability result;
  result.unit = unit;
  result.information = information;
  result.prior = prior;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> data(information);
  const Eigen::VectorXd& value = data.eigenvalues();
  const Eigen::MatrixXd& vector = data.eigenvectors();

  const Eigen::MatrixXd covariance = BoundedCovariance(information + prior);
  result.correlation.resize(n, n);
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      result.correlation(i, j) =
          covariance(i, j) / std::sqrt(covariance(i, i) * covariance(j, j));
    }
  }
  for (int i = 0; i < n; ++i) {
    // Variance from the data alone; a real share in a null direction is fatal.
    double variance = 0;
    bool null = false, held_by_prior = prior(i, i) > 0;
    for (int k = 0; k < n; ++k) {
      const double share = vector(i, k) * vector(i, k);
      if (value[k] < Identifiability::kNull) {
        null |= share > 0.01;
      } else {
        variance += share / value[k];
      }
    }
    const ParameterStatus status = null ? ParameterStatus::kUnidentifiable
                                   : held_by_prior && variance > 1
                                       ? ParameterStatus::kPriorDominated
                                       : ParameterStatus::kEstimated;
    result.status.push_back(status);
    result.bounded_std.push_back(unit[i] * std::sqrt(covariance(i, i)));
    result.std.push_back(null && !held_by_prior
                             ? std::numeric_limits<double>::infinity()
                             : result.bounded_std.back());
  }
  for (int k = 0; k < n && value[k] < 1; ++k) {
    WeakDirection direction;
    direction.direction = vector.col(k);
    direction.null = value[k] < Identifiability::kNull;
    // Below that the eigenvalue is rounding.
    direction.std_over_prior = direction.null
                                   ? std::numeric_limits<double>::infinity()
                                   : 1 / std::sqrt(value[k]);
    for (int i = 0; i < n; ++i) {
      if (std::abs(vector(i, k)) > 0.15) {
        direction.components.push_back({parameters.free()[i], vector(i, k)});
      }
    }
    std::sort(direction.components.begin(), direction.components.end(),
              [](const auto& a, const auto& b) {
                return std::abs(a.share) > std::abs(b.share);
              });
    DescribeWeakDirection(*problem, &direction);
    result.weak.push_back(std::move(direction));
  }

  // Degrees of freedom by family: each residual counts one less its leverage,
  // c cov c' by the parameters and that by its contact.
  for (std::size_t i = 0; i < at.rows.size(); ++i) {
    Identifiability::Noise& noise =
        result.noise[static_cast<int>(at.rows[i].family)];
    ++noise.residuals;
    noise.chi2 += at.weighted_residuals[i] * at.weighted_residuals[i];
  }
  for (int f = 0; f < kResidualFamilies; ++f) {
    result.noise[f].dof =
        result.noise[f].residuals - at.contact_leverage[f] -
        covariance.cwiseProduct(scaled(at.information_by_family[f])).sum();
  }
  return result;
}

}  // namespace finray
