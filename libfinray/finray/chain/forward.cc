#include "finray/chain/forward.h"

#include <ceres/problem.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "finray/chain/finger_equations.h"

namespace finray {
namespace {

constexpr int kMaxIterations = 40;
constexpr double kMaxTurn = 0.5;
// Newton squares the error: after a step this small rounding is all that is
// left.
constexpr double kSmallStep = 1e-9;
constexpr double kSmallestRampStep = 1. / 512;

bool IsBadContact(const ChainLayout& layout, const PointContact& contact) {
  // Written so that a NaN is bad.
  return contact.side != Side::kFront ||
         !(contact.arc_mm >= 0 && contact.arc_mm <= layout.length_unit_mm) ||
         !std::isfinite(contact.normal_N) || !std::isfinite(contact.friction);
}

// Solves with a growing share of the prestress and of the contact force.
bool SolveAlongRamp(const ChainLayout& layout, const PointContact& contact,
                    ChainState* state) {
  ChainLayout part = layout;
  PointContact load = contact;
  double reached = 0, step = 0.25;
  while (reached < 1) {
    const double share = std::min(1.0, reached + step);
    for (std::size_t k = 0; k < part.ribs.size(); ++k) {
      const double nominal = (part.ribs[k].left - part.ribs[k].right).norm();
      part.ribs[k].length_mm =
          nominal + share * (layout.ribs[k].length_mm - nominal);
    }
    load.normal_N = share * contact.normal_N;
    if (ContinueForward(part, load, kSmallStep, state)) {
      reached = share;
      step *= 2;
    } else {
      step /= 2;
      if (step < kSmallestRampStep) return false;
    }
  }
  return true;
}

}  // namespace

bool SolveForward(const ChainLayout& layout, const PointContact& contact,
                  ChainState* state) {
  *state = ChainState::Straight(layout);
  if (ContinueForward(layout, contact, kSmallStep, state) ||
      SolveAlongRamp(layout, contact, state)) {
    return true;
  }
  *state = ChainState::Straight(layout);
  return false;
}

bool ContinueForward(const ChainLayout& layout, const PointContact& contact,
                     double last_step, ChainState* state, int* iterations) {
  if (IsBadContact(layout, contact)) return false;
  const int n = layout.joints(), size = n + layout.loads();
  const ScaledEquations equations{layout, contact.friction};
  const Eigen::VectorXd units = equations.ColumnUnits().head(size);
  const double at[2] = {contact.arc_mm, contact.normal_N};
  ChainState now = *state;
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    const Eigen::VectorXd c =
        equations.Residual(now.theta.data(), now.loads.data(), at);
    if (!c.allFinite()) return false;
    const Eigen::MatrixXd jacobian =
        equations.Jacobian(now.theta.data(), now.loads.data(), at)
            .leftCols(size) *
        units.asDiagonal();
    // (6) prints a plus, which would lead away from the solution.
    const Eigen::VectorXd step = -jacobian.partialPivLu().solve(c);
    if (!step.allFinite()) return false;
    const double turn = LargestTurn(step.head(n));
    const double fraction = turn > kMaxTurn ? kMaxTurn / turn : 1;
    now.theta += fraction * step.head(n);
    now.loads +=
        fraction *
        step.tail(layout.loads()).cwiseProduct(units.tail(layout.loads()));
    const double scale =
        1 + now.loads.tail(layout.ribs.size()).cwiseAbs().sum() /
                layout.force_unit_N;
    if (step.cwiseAbs().maxCoeff() < last_step * scale) {
      if (!now.AllFinite()) return false;
      if (iterations != nullptr) *iterations = iteration + 1;
      *state = now;
      return true;
    }
  }
  return false;
}

bool ContinueForwardWithCeres(const ChainLayout& layout,
                              const PointContact& contact,
                              ceres::LinearSolverType linear_solver,
                              ChainState* state, int* iterations) {
  // For scaled rows; Newton's last step leaves less.
  constexpr double kSolved = 1e-9;
  ChainState now = *state;
  double at[2] = {contact.arc_mm, contact.normal_N};
  ceres::Problem problem;
  problem.AddResidualBlock(
      new ChainCost(ScaledEquations{layout, contact.friction}), nullptr,
      now.theta.data(), now.loads.data(), at);
  problem.SetParameterBlockConstant(at);
  ceres::Solver::Options options = ChainSolverOptions(linear_solver);
  options.gradient_tolerance = 1e-12;
  options.parameter_tolerance = 1e-12;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  if (iterations != nullptr)
    *iterations = static_cast<int>(summary.iterations.size()) - 1;
  if (!summary.IsSolutionUsable() || !now.AllFinite() ||
      !(summary.final_cost < 0.5 * kSolved * kSolved)) {
    return false;
  }
  *state = now;
  return true;
}

}  // namespace finray
