#include "finray/calib/identifiability.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "finray/calib/eliminated_contact.h"
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
  const CalibrationProblem::Linearization at = problem->Linearize(true);
  const CalibrationParameters& parameters = problem->parameters();
  const int n = static_cast<int>(parameters.free().size());

  Eigen::VectorXd unit(n);
  Eigen::MatrixXd prior = Eigen::MatrixXd::Zero(n, n);  // in those units
  for (int i = 0; i < n; ++i) {
    const CalibrationParameter& p = parameters.all()[parameters.free()[i]];
    unit[i] = p.prior_std.value_or(p.scale);
    if (p.prior_std) prior(i, i) = 1;
  }
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(n, n);
  ForEachFrame(at, [&](int first, int count) {
    const Eigen::MatrixXd c =
        EliminateContact(at, first, count) * unit.asDiagonal();
    information.selfadjointView<Eigen::Lower>().rankUpdate(c.transpose());
  });
  information = information.selfadjointView<Eigen::Lower>();

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

  // Degrees of freedom by family: each residual counts one less its leverage.
  ForEachFrame(at, [&](int first, int count) {
    const Eigen::MatrixXd c =
        EliminateContact(at, first, count) * unit.asDiagonal();
    const auto e = at.by_contact.middleRows(first, count);
    const Eigen::Matrix2d inverse = PseudoInverse(e.transpose() * e);
    for (int i = 0; i < count; ++i) {
      const double leverage = c.row(i).dot(covariance * c.row(i).transpose()) +
                              e.row(i).dot(inverse * e.row(i).transpose());
      Identifiability::Noise& noise =
          result.noise[static_cast<int>(at.rows[first + i].family)];
      ++noise.residuals;
      noise.dof += 1 - leverage;
      noise.chi2 += at.residuals[first + i] * at.residuals[first + i];
    }
  });
  return result;
}

}  // namespace finray
