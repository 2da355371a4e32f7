#include "finray/calib/analysis/cross_validation.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include "finray/calib/analysis/validation.h"
#include "finray/calib/solve/information_spectrum.h"

namespace finray {
namespace {

// What frames say about the free parameters, in their units.
struct ScaledSums {
  Eigen::MatrixXd information;
  Eigen::VectorXd gradient;
};

ScaledSums OfFold(const WideLinearization& wide, int fold,
                  const Eigen::VectorXd& unit) {
  const Linearization& at = wide.folds[fold];
  const Eigen::MatrixXd information = at.Information();
  return {InUnits(information(wide.free, wide.free), unit),
          Eigen::VectorXd(at.gradient(wide.free)).cwiseProduct(unit)};
}

ScaledSums OfAll(const CalibrationProblem& problem,
                 const WideLinearization& wide, const Eigen::VectorXd& unit) {
  ScaledSums sums = OfFold(wide, 0, unit);
  for (int fold = 1; fold < WideLinearization::kFolds; ++fold) {
    const ScaledSums of = OfFold(wide, fold, unit);
    sums.information += of.information;
    sums.gradient += of.gradient;
  }
  for (Eigen::Index k = 0; k < unit.size(); ++k) {
    const CalibrationParameter& p =
        problem.parameters().FreeParameter(static_cast<std::size_t>(k));
    if (!p.prior_std) continue;
    sums.information(k, k) += 1;
    sums.gradient[k] += p.PriorResidual();
  }
  return sums;
}

}  // namespace

LeftOut LeaveFoldOut(const CalibrationProblem& problem,
                     const WideLinearization& wide, int fold) {
  const Eigen::VectorXd unit = problem.parameters().Units();
  const ScaledSums all = OfAll(problem, wide, unit);
  const ScaledSums own = OfFold(wide, fold, unit);
  const Eigen::MatrixXd rest = all.information - own.information;
  LeftOut left;
  left.covariance = BoundedCovariance(rest);
  const Eigen::VectorXd move = -left.covariance * (all.gradient - own.gradient);
  left.values = problem.Values() + unit.cwiseProduct(move);
  const Eigen::VectorXd gradient = own.gradient + own.information * move;
  const double chi2 =
      2 * wide.folds[fold].cost + move.dot(own.gradient + gradient);
  // det H / det H_k as det(I + F' S_k F) with F F' = H_k^-1.
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(left.covariance);
  const Eigen::MatrixXd factor =
      eigen.eigenvectors() *
      eigen.eigenvalues().cwiseMax(0).cwiseSqrt().asDiagonal();
  Eigen::MatrixXd ratio = factor.transpose() * own.information * factor;
  ratio.diagonal().array() += 1;
  const Eigen::LLT<Eigen::MatrixXd> root(ratio);
  const Eigen::MatrixXd l = root.matrixL();
  // g'H^-1 g = |(I + F' S_k F)^-1/2 F'g|^2
  const Eigen::VectorXd pulled =
      root.matrixL().solve(Eigen::VectorXd(factor.transpose() * gradient));
  left.log_likelihood =
      -0.5 * (chi2 - pulled.squaredNorm()) - l.diagonal().array().log().sum();
  return left;
}

void ForEachFold(
    const CalibrationProblem& problem, const WideLinearization& wide,
    const std::function<void(int fold, const LeftOut& left)>& use) {
  // One thread calls LAPACK.
  std::vector<LeftOut> left;
  for (int fold = 0; fold < WideLinearization::kFolds; ++fold) {
    left.push_back(LeaveFoldOut(problem, wide, fold));
  }
  tbb::task_arena(problem.threads()).execute([&] {
    tbb::parallel_for(0, WideLinearization::kFolds,
                      [&](int fold) { use(fold, left[fold]); });
  });
}

LeftOutFinger::LeftOutFinger(const CalibrationProblem& problem,
                             const Identifiability& found, const LeftOut& left,
                             const std::vector<int>& frames)
    : part(problem.Part(frames, 1)) {
  part->SetValues(left.values);
  Identifiability known = found;
  known.covariance = left.covariance;
  const Eigen::VectorXd std = left.covariance.diagonal().cwiseSqrt();
  known.correlation = left.covariance.cwiseQuotient(std * std.transpose());
  for (std::size_t k = 0; k < known.bounded_std.size(); ++k) {
    const auto at = static_cast<Eigen::Index>(k);
    known.bounded_std[k] *= std[at] / std::sqrt(found.covariance(at, at));
  }
  finger = part->parameters().Apply(problem.finger());
  KeepCovariance(part->parameters(), known, &finger);
}

double CrossValidatedLogLikelihood(const CalibrationProblem& problem,
                                   const WideLinearization& wide) {
  double sum = 0;
  for (int fold = 0; fold < WideLinearization::kFolds; ++fold) {
    if (wide.frames[fold].empty()) continue;
    sum += LeaveFoldOut(problem, wide, fold).log_likelihood;
  }
  return sum;
}

CrossValidation CrossValidate(
    const CalibrationProblem& problem, const Identifiability& found,
    const WideLinearization& wide, const FrameEstimator* estimator,
    const std::optional<GaugeDiscrepancy>& discrepancy) {
  CrossValidation result;
  result.errors.front_length_mm = problem.finger().front_length_mm;
  for (const std::vector<int>& frames : wide.frames) {
    if (frames.empty()) return result;
  }
  const Finger solved = problem.parameters().Apply(problem.finger());
  struct Fold {
    SensedFrames sensed;
    double friction = 0;
  };
  std::array<Fold, WideLinearization::kFolds> folds;
  ForEachFold(problem, wide, [&](int fold, const LeftOut& left) {
    const std::vector<int>& frames = wide.checked[fold];
    if (frames.empty()) return;
    LeftOutFinger without(problem, found, left, frames);
    std::unique_ptr<FrameEstimator> own;
    if (estimator != nullptr && without.finger.calibration) {
      without.finger.calibration->discrepancy = discrepancy;
      own = estimator->WithErrorsOf(*without.finger.calibration);
    }
    const Eigen::VectorXd moved = left.values - problem.Values();
    std::vector<Measurements> readings =
        SensedReadings(problem.Part(frames, 1).get(), solved, frames);
    for (std::size_t k = 0; k < frames.size(); ++k) {
      const Eigen::VectorXd more_V = wide.readings_V.at(frames[k]) * moved;
      for (std::size_t j = 0; j < readings[k].gauges_V.size(); ++j) {
        readings[k].gauges_V[j] -= more_V[static_cast<Eigen::Index>(j)];
      }
    }
    folds[fold] = {
        {ReferencesAt(without.part.get(), without.finger, frames, nullptr),
         EstimateReadings(own ? own.get() : estimator, readings, 1)},
        without.part->parameters().friction()};
  });
  for (const Fold& fold : folds) {
    const std::size_t frames = fold.sensed.estimates.size();
    for (std::size_t k = 0; k < frames; ++k) {
      fold.sensed.AddTo(&result.errors, k, fold.friction);
    }
    result.folds += frames > 0 ? 1 : 0;
  }
  return result;
}

}  // namespace finray
