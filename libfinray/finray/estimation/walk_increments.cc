#include "finray/estimation/walk_increments.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "finray/estimation/chi_squared.h"

namespace finray {
namespace {

// A lag with fewer degrees of freedom says little about a scale.
constexpr double kFewest = 8;

double Tail(double chi2, double dof) {
  return ChiSquaredTail(chi2, static_cast<int>(dof));
}

}  // namespace

void WalkIncrements::Add(std::size_t lag, const Eigen::VectorXd& moved,
                         double seconds, const Eigen::MatrixXd& covariance) {
  const double told = told_V_per_sqrt_s * told_V_per_sqrt_s * seconds;
  const Eigen::Index gauges = moved.size();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> directions(
      Eigen::MatrixXd::Identity(gauges, gauges) - covariance / told);
  for (Eigen::Index i = 0; i < gauges; ++i) {
    const double share = directions.eigenvalues()[i];
    if (!(share > kTold)) continue;
    const double along = directions.eigenvectors().col(i).dot(moved);
    const double square = along * along / (told * share);
    chi2[lag] += square;
    ++dof[lag];
    weights[lag] += share * share;
    weighted[lag] += share * (square - 1 + share);
  }
  if (lag + 1 < kLags) return;
  moved_V.resize(static_cast<std::size_t>(gauges));
  for (Eigen::Index j = 0; j < gauges; ++j) moved_V[j] += moved[j];
  moved_s += seconds;
}

void WalkIncrements::Add(const WalkIncrements& other) {
  told_V_per_sqrt_s = std::max(told_V_per_sqrt_s, other.told_V_per_sqrt_s);
  for (std::size_t lag = 0; lag < kLags; ++lag) {
    chi2[lag] += other.chi2[lag];
    dof[lag] += other.dof[lag];
    weights[lag] += other.weights[lag];
    weighted[lag] += other.weighted[lag];
  }
  moved_V.resize(std::max(moved_V.size(), other.moved_V.size()));
  for (std::size_t j = 0; j < other.moved_V.size(); ++j) {
    moved_V[j] += other.moved_V[j];
  }
  moved_s += other.moved_s;
}

std::optional<double> WalkIncrements::ShortLag() const {
  for (std::size_t lag = 0; lag < kLags; ++lag) {
    if (dof[lag] >= kFewest) return chi2[lag] / dof[lag];
  }
  return {};
}

WalkIncrements::Verdict WalkIncrements::Judge() const {
  const std::optional<double> at_short = ShortLag();
  if (!at_short) return Verdict::kFits;
  bool too_small = false, too_large = false, drifts = false;
  for (std::size_t lag = 0; lag < kLags; ++lag) {
    if (dof[lag] < 1) continue;
    const double scale = chi2[lag] / dof[lag];
    too_small |= scale > kFactor && Tail(chi2[lag], dof[lag]) < kSignificance;
    too_large |= scale < 1 / (kFactor * kFactor) &&
                 1 - Tail(chi2[lag], dof[lag]) < kSignificance;
    drifts |=
        scale > kFactor * kFactor * *at_short &&
        Tail(chi2[lag] / std::max(1.0, *at_short), dof[lag]) < kSignificance;
  }
  return too_small   ? drifts ? Verdict::kDrift : Verdict::kTooSmall
         : too_large ? Verdict::kTooLarge
                     : Verdict::kFits;
}

double WalkIncrements::FittingWalk() const {
  const auto best = static_cast<std::size_t>(
      std::max_element(weights.begin(), weights.end()) - weights.begin());
  if (weights[best] == 0) return told_V_per_sqrt_s;
  return told_V_per_sqrt_s * std::sqrt(std::max(weighted[best] / weights[best],
                                                kLeastShare * kLeastShare));
}

}  // namespace finray
