#include "finray/chain/ceres_forward.h"

#include <ceres/problem.h>
#include <ceres/solver.h>

#include "finray/chain/chain_cost.h"

namespace finray {

bool ContinueForwardWithCeres(const ChainLayout& layout,
                              const ChainContact& contact,
                              ceres::LinearSolverType linear_solver,
                              ChainState* state, int* iterations) {
  // Of residuals in the units of ChainUnits; Newton's last step leaves less.
  constexpr double kSolved = 1e-9;
  ChainState now = *state;
  double at[2] = {contact.arc_mm, contact.normal_N};
  ceres::Problem problem;
  problem.AddResidualBlock(new TipClosureCost(&layout, 1), nullptr,
                           now.theta.data());
  problem.AddResidualBlock(new JointTorqueCost(&layout, 1, contact.friction),
                           nullptr, now.theta.data(), now.loads.data(), at);
  if (!layout.ribs.empty()) {
    problem.AddResidualBlock(new RibDistanceCost(&layout, 1), nullptr,
                             now.theta.data(), now.loads.data());
  }
  problem.SetParameterBlockConstant(at);
  ceres::Solver::Options options;
  options.linear_solver_type = linear_solver;
  options.initial_trust_region_radius = 1e12;
  options.max_trust_region_radius = 1e16;
  options.function_tolerance = 1e-16;
  options.gradient_tolerance = 1e-12;
  options.parameter_tolerance = 1e-12;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  if (iterations != nullptr) {
    *iterations = static_cast<int>(summary.iterations.size()) - 1;
  }
  if (!summary.IsSolutionUsable() || !now.AllFinite() ||
      !(summary.final_cost < 0.5 * kSolved * kSolved)) {
    return false;
  }
  *state = now;
  return true;
}

}  // namespace finray
