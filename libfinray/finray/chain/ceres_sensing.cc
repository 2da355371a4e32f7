#include "finray/chain/ceres_sensing.h"

#include <ceres/problem.h>
#include <ceres/solver.h>

#include <algorithm>
#include <cmath>

#include "finray/chain/chain_cost.h"
#include "finray/chain/forward.h"

namespace finray {

namespace {

// One minimisation with one weight. True where Ceres calls it converged.
bool Minimise(const ChainLayout& layout, const Eigen::VectorXd& s0,
              double friction, double gauge_std_rad, double model_weight,
              int max_iterations, ceres::LinearSolverType linear_solver,
              ChainState* state, double* contact, int* iterations) {
  double* theta = state->theta.data();
  double* loads = state->loads.data();
  const double weight = model_weight / gauge_std_rad;
  ceres::Problem problem;
  problem.AddResidualBlock(new TipClosureCost(&layout, weight), nullptr, theta);
  problem.AddResidualBlock(new JointTorqueCost(&layout, weight, friction),
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

  ceres::Solver::Options options;
  options.linear_solver_type = linear_solver;
  // The default radius damps the gauge rows, light beside the model's, away.
  options.initial_trust_region_radius = 1e12;
  options.max_trust_region_radius = 1e16;
  options.function_tolerance = 1e-16;
  options.gradient_tolerance = 1e-20;
  options.parameter_tolerance = 1e-13;
  // Near the minimum rounding of the model's rows hides what a step gains.
  options.use_nonmonotonic_steps = true;
  options.max_num_iterations = max_iterations;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  *iterations += static_cast<int>(summary.iterations.size()) - 1;
  return summary.termination_type == ceres::CONVERGENCE && state->AllFinite();
}

// Where Ceres stops without a minimum: on a bound, or where x_c jumps.
bool Parked(const ChainLayout& layout, const double* contact) {
  const double hair = 1e-6 * layout.length_unit_mm;
  for (const double joint : layout.front_joint_mm) {
    if (std::abs(contact[0] - joint) < hair) return true;
  }
  return contact[0] < hair || contact[0] > layout.length_unit_mm - hair ||
         contact[1] <= 0;
}

}  // namespace

ChainSensing SenseContactWithCeres(const ChainLayout& layout,
                                   const Eigen::VectorXd& s0,
                                   const ChainContact& start,
                                   double gauge_std_rad,
                                   const ChainSensingOptions& options,
                                   ceres::LinearSolverType linear_solver) {
  ChainSensing result;
  if (!StartSensing(layout, s0, start, &result)) return result;

  ChainState state = result.state;
  double contact[2] = {start.arc_mm, start.normal_N};
  // Ceres wants the cost to fall with every step, and with heavy model rows the
  // second-order error of a long step outweighs all that the gauges gain. So
  // the weight grows by stages, the last of which has little left to do.
  bool converged = false;
  for (double weight = std::min(1.0, options.model_weight);;) {
    converged = Minimise(layout, s0, start.friction, gauge_std_rad, weight,
                         options.max_iterations, linear_solver, &state, contact,
                         &result.iterations);
    if (weight == options.model_weight || !state.AllFinite()) break;
    weight = std::min(100 * weight, options.model_weight);
  }
  if (!state.AllFinite()) return result;
  result.state = state;
  result.contact.arc_mm = contact[0];
  result.contact.normal_N = contact[1];
  result.misfit = layout.gauges * state.theta - s0;
  result.converged = converged && !Parked(layout, contact);
  return result;
}

}  // namespace finray
