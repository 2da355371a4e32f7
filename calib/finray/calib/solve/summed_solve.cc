#include "finray/calib/solve/summed_solve.h"

#include <ceres/problem.h>
#include <ceres/solver.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "finray/calib/solve/frame_pass.h"
#include "finray/calib/solve/information_spectrum.h"
#include "finray/io/number_text.h"

namespace finray {

std::optional<Linearization> FitFrames(const std::vector<int>& frames,
                                       CalibrationProblem* problem,
                                       ContactStore* contacts) {
  const Contacts before = contacts->all();
  Linearization at(static_cast<int>(problem->parameters().free().size()),
                   frames.size());
  bool good = true;
  FitContacts(frames, problem, contacts,
              [&](int i, const LinearizedFrame& frame) {
                good = good && !frame.rows.empty();
                if (!good) return;
                at.Add(i, problem->frame(i).log, frame);
                contacts->Move(i, frame.move.now);
              });
  if (!good) {
    contacts->Set(before);
    return {};
  }
  at.Finish();
  return at;
}

FrameSums SumsWithPriors(const Linearization& at,
                         const CalibrationParameters& parameters) {
  FrameSums sums = {at.Information(), at.gradient, at.cost};
  for (Eigen::Index k = 0; k < sums.gradient.size(); ++k) {
    const CalibrationParameter& p = parameters.FreeParameter(k);
    if (!p.prior_std) continue;
    const double residual = p.PriorResidual();
    sums.information(k, k) += 1 / (*p.prior_std * *p.prior_std);
    sums.gradient[k] += residual / *p.prior_std;
    sums.cost += residual * residual / 2;
  }
  return sums;
}

FrameSumResidual::FrameSumResidual(const Eigen::VectorXd& start,
                                   const Eigen::MatrixXd& units,
                                   Evaluator evaluator)
    : start_(start), units_(units), evaluator_(std::move(evaluator)) {
  const int n = static_cast<int>(units.cols());
  set_num_residuals(n + 1);
  mutable_parameter_block_sizes()->push_back(n);
}

bool FrameSumResidual::Evaluate(double const* const* parameters,
                                double* residuals, double** jacobians) const {
  using RowMajor =
      Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const Eigen::Index n = units_.cols();
  const Eigen::Map<const Eigen::VectorXd> z(parameters[0], n);
  FrameSums sums;
  if (!evaluator_(start_ + units_ * z, &sums)) return false;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(
      units_.transpose() * sums.information * units_);
  // If the frames do not determine a direction, the gradient along it is
  // rounding.
  const double least = 1e-14 * eigen.eigenvalues()[n - 1];
  const Eigen::VectorXd root = eigen.eigenvalues().cwiseMax(0).cwiseSqrt();
  Eigen::Map<Eigen::VectorXd> r(residuals, n + 1);
  r.head(n) =
      eigen.eigenvectors().transpose() * (units_.transpose() * sums.gradient);
  for (Eigen::Index k = 0; k < n; ++k) {
    r[k] = eigen.eigenvalues()[k] > least ? r[k] / root[k] : 0;
  }
  r[n] = std::sqrt(std::max(0.0, 2 * sums.cost - r.head(n).squaredNorm()));
  if (jacobians != nullptr && jacobians[0] != nullptr) {
    Eigen::Map<RowMajor> jacobian(jacobians[0], n + 1, n);
    jacobian.topRows(n) = root.asDiagonal() * eigen.eigenvectors().transpose();
    jacobian.row(n).setZero();
  }
  return true;
}

SummedSolution SolveSummed(const std::vector<int>& frames,
                           std::optional<Linearization> start,
                           CalibrationProblem* problem,
                           ContactStore* contacts) {
  contacts->RenewStates();
  const Eigen::VectorXd first = problem->Values();
  Eigen::VectorXd tried = first;
  std::optional<Linearization> at;  // at the values `tried`
  if (start && start->frames == frames) at = std::move(start);
  int steps = 0;
  const auto evaluate = [&](const Eigen::VectorXd& x, FrameSums* sums) {
    if (!at || x != tried) {
      problem->SetValues(tried = x);
      problem->Tell(std::to_string(frames.size()) + " frames, step " +
                    std::to_string(++steps));
      at.reset();
      at = FitFrames(frames, problem, contacts);
    }
    if (at) *sums = SumsWithPriors(*at, problem->parameters());
    return at.has_value();
  };
  FrameSums sums;
  if (!evaluate(first, &sums)) {
    throw std::runtime_error("the model cannot be evaluated at the start");
  }
  const Eigen::MatrixXd units =
      DeterminedUnits(sums.information, problem->parameters().Units());
  if (units.cols() == 0) {
    return {{true, 0, sums.cost, sums.cost, "nothing is determined"},
            std::move(*at)};
  }

  ceres::Problem residuals;
  Eigen::VectorXd z = Eigen::VectorXd::Zero(units.cols());
  residuals.AddResidualBlock(new FrameSumResidual(first, units, evaluate),
                             nullptr, z.data());
  ceres::Solver::Options options;
  options.logging_type = ceres::SILENT;
  options.linear_solver_type = ceres::DENSE_QR;
  options.initial_trust_region_radius = 1e10;
  options.max_trust_region_radius = 1e16;
  // A unit of z is one standard deviation.
  options.gradient_tolerance = problem->tolerance_std();
  options.function_tolerance = 0;
  options.parameter_tolerance = 0;
  ceres::Solver::Summary summary;
  const ClassicNumbers in_messages;
  ceres::Solve(options, &residuals, &summary);
  // Ceres may have rejected the last trial step. The contacts are then those of
  // that step.
  if (!evaluate(first + units * z, &sums)) {
    throw std::runtime_error("the model cannot be evaluated at the solution");
  }
  return {ReportOf(summary), std::move(*at)};
}

}  // namespace finray
