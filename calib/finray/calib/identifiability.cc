#include "finray/calib/identifiability.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "finray/calib/weak_direction_words.h"

namespace finray {
namespace {

// The part of a 2 x 2 information matrix that is not noise; a contact without
// force, say, says nothing of its place.
Eigen::Matrix2d PseudoInverse(const Eigen::Matrix2d& information) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(information);
  Eigen::Matrix2d inverse = Eigen::Matrix2d::Zero();
  for (int i = 0; i < 2; ++i) {
    const double value = eigen.eigenvalues()[i];
    if (value > 1e-12 * eigen.eigenvalues()[1] && value > 0) {
      inverse += eigen.eigenvectors().col(i) *
                 eigen.eigenvectors().col(i).transpose() / value;
    }
  }
  return inverse;
}

// Calls `visit(first, count)` for the rows of each frame.
template <class Visitor>
void ForEachFrame(const CalibrationProblem::Linearization& at,
                  const Visitor& visit) {
  const auto rows = static_cast<int>(at.rows.size());
  for (int first = 0; first < rows;) {
    int last = first;
    while (last < rows && at.rows[last].frame == at.rows[first].frame) ++last;
    visit(first, last - first);
    first = last;
  }
}

// Rows of a frame with its contact eliminated: C - E (E'E)^-1 E'C.
Eigen::MatrixXd EliminateContact(const CalibrationProblem::Linearization& at,
                                 int first, int count) {
  const auto c = at.by_parameter.middleRows(first, count);
  const auto e = at.by_contact.middleRows(first, count);
  return c - e * (PseudoInverse(e.transpose() * e) * (e.transpose() * c));
}

}  // namespace

const char* ParameterStatusName(ParameterStatus status) {
  constexpr const char* kNames[] = {"estimated", "prior_dominated",
                                    "unidentifiable", "fixed"};
  return kNames[static_cast<int>(status)];
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
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> data(information);
  const Eigen::VectorXd& value = data.eigenvalues();
  const Eigen::MatrixXd& vector = data.eigenvectors();

  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> posterior(information +
                                                                 prior);
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(n, n);
  for (int k = 0; k < n; ++k) {
    const double bounded =
        std::max(posterior.eigenvalues()[k],
                 Identifiability::kNull * Identifiability::kNull);
    covariance += posterior.eigenvectors().col(k) *
                  posterior.eigenvectors().col(k).transpose() / bounded;
  }
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
