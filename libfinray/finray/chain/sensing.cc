#include "finray/chain/sensing.h"

#include <ceres/problem.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "finray/chain/finger_equations.h"
#include "finray/chain/forward.h"

namespace finray {
namespace {

constexpr int kMaxSensingIterations = 60;
constexpr double kMaxSensingTurn = 0.5;
constexpr double kMaxMove = 0.03;   // of l_0
constexpr double kMaxChange = 0.3;  // of f_c + F_0
constexpr double kSmallSensingStep = 1e-9;

// The step of (18) in units of the columns. The print adds it; Newton
// subtracts.
Eigen::VectorXd Step(const ScaledEquations& equations,
                     const Eigen::VectorXd& column_units,
                     const ChainState& state, const PointContact& contact) {
  const double* theta = state.theta.data();
  const double* loads = state.loads.data();
  const double at[2] = {contact.arc_mm, contact.normal_N};
  const Eigen::VectorXd c = equations.Residual(theta, loads, at);
  const Eigen::MatrixXd jacobian =
      equations.Jacobian(theta, loads, at) * column_units.asDiagonal();
  if (!c.allFinite() || !jacobian.allFinite()) {
    return Eigen::VectorXd::Constant(jacobian.cols(), std::nan(""));
  }
  return -jacobian.colPivHouseholderQr().solve(c);
}

// Fills `result` with the start of both ways of sensing: the equilibrium under
// `start` and its misfit. False if there is none or s0 is not finite.
bool StartSensing(const ChainLayout& layout, const Eigen::VectorXd& s0,
                  const PointContact& start, ChainSensing* result) {
  result->contact = start;
  const bool started = SolveForward(layout, start, &result->state);
  result->misfit = layout.gauges * result->state.theta - s0;
  return started && s0.allFinite();
}

// One minimisation with one weight of the model. True if Ceres says that it
// converged.
bool Minimise(const ScaledEquations& equations,
              ceres::LinearSolverType linear_solver, ChainState* state,
              double* contact, int* iterations) {
  ceres::Problem problem;
  problem.AddResidualBlock(new ChainCost(equations), nullptr,
                           state->theta.data(), state->loads.data(), contact);
  problem.SetParameterLowerBound(contact, 0, 0);
  problem.SetParameterUpperBound(contact, 0, equations.layout.length_unit_mm);
  problem.SetParameterLowerBound(contact, 1, 0);
  ceres::Solver::Options options = ChainSolverOptions(linear_solver);
  options.gradient_tolerance = 1e-20;
  options.parameter_tolerance = 1e-13;
  // Near the minimum rounding of the model's rows hides what a step gains.
  options.use_nonmonotonic_steps = true;
  options.max_num_iterations = kMaxSensingIterations;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  *iterations += static_cast<int>(summary.iterations.size()) - 1;
  return summary.termination_type == ceres::CONVERGENCE && state->AllFinite();
}

// Returns true if l_c or f_c is on a bound, or l_c at a joint. Ceres stops
// there without a minimum.
bool IsParked(const ChainLayout& layout, const double* contact) {
  const double hair = 1e-6 * layout.length_unit_mm;
  for (const double joint : layout.front_joint_mm) {
    if (std::abs(contact[0] - joint) < hair) return true;
  }
  return contact[0] < hair || contact[0] > layout.length_unit_mm - hair ||
         contact[1] <= 0;
}

}  // namespace

ChainSensing SenseContact(const ChainLayout& layout, const Eigen::VectorXd& s0,
                          const PointContact& start, double model_weight) {
  const int n = layout.joints(), loads = layout.loads();
  const ScaledEquations equations{layout, start.friction, model_weight, s0};
  const Eigen::VectorXd units = equations.ColumnUnits();
  ChainSensing result;
  if (!StartSensing(layout, s0, start, &result)) return result;

  ChainState state = result.state;
  PointContact contact = start;
  while (result.iterations < kMaxSensingIterations) {
    ++result.iterations;
    const Eigen::VectorXd step = Step(equations, units, state, contact);
    if (!step.allFinite()) break;
    const double fraction =
        std::min({1.0, kMaxSensingTurn / LargestTurn(step.head(n)),
                  kMaxMove / std::abs(step[n + loads]),
                  kMaxChange * (1 + contact.normal_N / layout.force_unit_N) /
                      std::abs(step[n + loads + 1])});
    const Eigen::VectorXd change = fraction * step.cwiseProduct(units);
    state.theta += change.head(n);
    state.loads += change.segment(n, loads);
    const double arc = contact.arc_mm + change[n + loads];
    const double normal = contact.normal_N + change[n + loads + 1];
    contact.arc_mm = std::clamp(arc, 0.0, layout.length_unit_mm);
    contact.normal_N = std::max(0.0, normal);
    const bool on_bound = contact.arc_mm <= 0 || contact.normal_N <= 0 ||
                          contact.arc_mm >= layout.length_unit_mm;
    if (!on_bound && step.cwiseAbs().maxCoeff() < kSmallSensingStep &&
        state.AllFinite()) {
      result.converged = true;
      break;
    }
  }
  if (state.AllFinite()) {
    result.state = state;
    result.contact = contact;
    result.misfit = layout.gauges * state.theta - s0;
  }
  return result;
}

ChainSensing SenseContactWithCeres(const ChainLayout& layout,
                                   const Eigen::VectorXd& s0,
                                   const PointContact& start,
                                   double gauge_std_rad, double model_weight,
                                   ceres::LinearSolverType linear_solver) {
  ChainSensing result;
  if (!StartSensing(layout, s0, start, &result)) return result;

  ChainState state = result.state;
  double contact[2] = {start.arc_mm, start.normal_N};
  // With heavy model rows the second-order error of a long step outweighs all
  // that the gauges gain, and Ceres rejects the step. So the weight grows by
  // stages, and the last one has little left to do.
  bool converged = false;
  for (double weight = std::min(1.0, model_weight);;) {
    const ScaledEquations equations{layout, start.friction,
                                    weight / gauge_std_rad, s0, gauge_std_rad};
    converged =
        Minimise(equations, linear_solver, &state, contact, &result.iterations);
    if (weight == model_weight || !state.AllFinite()) break;
    weight = std::min(100 * weight, model_weight);
  }
  if (!state.AllFinite()) return result;
  result.state = state;
  result.contact.arc_mm = contact[0];
  result.contact.normal_N = contact[1];
  result.misfit = layout.gauges * state.theta - s0;
  result.converged = converged && !IsParked(layout, contact);
  return result;
}

}  // namespace finray
