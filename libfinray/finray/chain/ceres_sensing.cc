#include "finray/chain/ceres_sensing.h"

#include <ceres/problem.h>
#include <ceres/solver.h>

#include "finray/chain/chain_cost.h"
#include "finray/chain/forward.h"

namespace finray {

ChainSensing SenseContactWithCeres(const ChainLayout& layout,
                                   const Eigen::VectorXd& s0,
                                   const ChainContact& start,
                                   double gauge_std_rad,
                                   const ChainSensingOptions& options) {
  ChainSensing result;
  result.contact = start;
  const bool started = SolveForward(layout, start, &result.state);
  result.misfit = layout.gauges * result.state.theta - s0;
  if (!started || !s0.allFinite()) return result;

  ChainState state = result.state;
  double contact[2] = {start.arc_mm, start.normal_N};
  double* theta = state.theta.data();
  double* loads = state.loads.data();
  const double weight = options.model_weight / gauge_std_rad;
  ceres::Problem problem;
  problem.AddResidualBlock(new TipClosureCost(&layout, weight), nullptr, theta);
  problem.AddResidualBlock(new JointTorqueCost(&layout, weight, start.friction),
                           nullptr, theta, loads, contact);
  if (!layout.ribs.empty()) {
    problem.AddResidualBlock(new RibDistanceCost(&layout, weight), nullptr,
                             theta, loads);
  }
  problem.AddResidualBlock(new GaugeAngleCost(&layout, s0, gauge_std_rad),
                           nullptr, theta);
  problem.SetParameterLowerBound(contact, 0, 0);
  problem.SetParameterUpperBound(contact, 0, layout.length_unit_mm);
  problem.SetParameterLowerBound(contact, 1, 0);

  ceres::Solver::Options solver;
  solver.linear_solver_type = ceres::DENSE_QR;
  // The default radius damps the gauge rows, light beside the model's, away.
  solver.initial_trust_region_radius = 1e12;
  solver.max_trust_region_radius = 1e16;
  solver.function_tolerance = 1e-16;
  solver.gradient_tolerance = 1e-20;
  solver.parameter_tolerance = 1e-12;
  solver.max_num_iterations = options.max_iterations;
  solver.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(solver, &problem, &summary);
  result.iterations = static_cast<int>(summary.iterations.size()) - 1;
  if (!summary.IsSolutionUsable() || !state.AllFinite()) return result;

  result.state = state;
  result.contact.arc_mm = contact[0];
  result.contact.normal_N = contact[1];
  result.misfit = layout.gauges * state.theta - s0;
  result.converged = summary.termination_type == ceres::CONVERGENCE;
  return result;
}

}  // namespace finray
