#include "finray/chain/ceres_chain.h"

#include <ceres/cost_function.h>
#include <ceres/problem.h>
#include <ceres/solver.h>

#include <algorithm>
#include <cmath>

#include "finray/chain/forward.h"
#include "finray/chain/scaled_equations.h"

namespace finray {
namespace {

// Ceres keeps Jacobian blocks by rows.
using RowMajor =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

class ChainCost : public ceres::CostFunction {
 public:
  explicit ChainCost(const ScaledEquations& equations) : equations_(equations) {
    set_num_residuals(equations.rows());
    *mutable_parameter_block_sizes() = {equations.layout.joints(),
                                        equations.layout.loads(), 2};
  }

  bool Evaluate(double const* const* x, double* residuals,
                double** jacobians) const override {
    Eigen::Map<Eigen::VectorXd> c(residuals, num_residuals());
    c = equations_.Residual(x[0], x[1], x[2]);
    if (jacobians != nullptr) {
      const Eigen::MatrixXd all = equations_.Jacobian(x[0], x[1], x[2]);
      int first = 0;
      for (int b = 0; b < 3; ++b) {
        const int size = parameter_block_sizes()[b];
        if (jacobians[b] != nullptr) {
          Eigen::Map<RowMajor>(jacobians[b], num_residuals(), size) =
              all.middleCols(first, size);
        }
        first += size;
      }
    }
    // False makes Ceres take a smaller step.
    return c.allFinite();
  }

 private:
  const ScaledEquations equations_;
};

ceres::Solver::Options Options(ceres::LinearSolverType linear_solver) {
  ceres::Solver::Options options;
  options.linear_solver_type = linear_solver;
  // The default radius damps away the gauge rows, which are light beside the
  // model's.
  options.initial_trust_region_radius = 1e12;
  options.max_trust_region_radius = 1e16;
  options.function_tolerance = 1e-16;
  options.logging_type = ceres::SILENT;
  return options;
}

int Iterations(const ceres::Solver::Summary& summary) {
  return static_cast<int>(summary.iterations.size()) - 1;
}

// One minimisation with one weight of the model. True if Ceres says that it
// converged.
bool Minimise(const ScaledEquations& equations, int max_iterations,
              ceres::LinearSolverType linear_solver, ChainState* state,
              double* contact, int* iterations) {
  ceres::Problem problem;
  problem.AddResidualBlock(new ChainCost(equations), nullptr,
                           state->theta.data(), state->loads.data(), contact);
  problem.SetParameterLowerBound(contact, 0, 0);
  problem.SetParameterUpperBound(contact, 0, equations.layout.length_unit_mm);
  problem.SetParameterLowerBound(contact, 1, 0);
  ceres::Solver::Options options = Options(linear_solver);
  options.gradient_tolerance = 1e-20;
  options.parameter_tolerance = 1e-13;
  // Near the minimum rounding of the model's rows hides what a step gains.
  options.use_nonmonotonic_steps = true;
  options.max_num_iterations = max_iterations;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  *iterations += Iterations(summary);
  return summary.termination_type == ceres::CONVERGENCE && state->AllFinite();
}

// Whether l_c and f_c are where Ceres stops without a minimum: on a bound or at
// a joint.
bool IsParked(const ChainLayout& layout, const double* contact) {
  const double hair = 1e-6 * layout.length_unit_mm;
  for (const double joint : layout.front_joint_mm) {
    if (std::abs(contact[0] - joint) < hair) return true;
  }
  return contact[0] < hair || contact[0] > layout.length_unit_mm - hair ||
         contact[1] <= 0;
}

}  // namespace

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
  ceres::Solver::Options options = Options(linear_solver);
  options.gradient_tolerance = 1e-12;
  options.parameter_tolerance = 1e-12;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  if (iterations != nullptr) *iterations = Iterations(summary);
  if (!summary.IsSolutionUsable() || !now.AllFinite() ||
      !(summary.final_cost < 0.5 * kSolved * kSolved)) {
    return false;
  }
  *state = now;
  return true;
}

ChainSensing SenseContactWithCeres(const ChainLayout& layout,
                                   const Eigen::VectorXd& s0,
                                   const PointContact& start,
                                   double gauge_std_rad,
                                   const ChainSensingOptions& options,
                                   ceres::LinearSolverType linear_solver) {
  ChainSensing result;
  if (!StartSensing(layout, s0, start, &result)) return result;

  ChainState state = result.state;
  double contact[2] = {start.arc_mm, start.normal_N};
  // With heavy model rows the second-order error of a long step outweighs all
  // that the gauges gain, and Ceres rejects the step. So the weight grows by
  // stages, and the last one has little left to do.
  bool converged = false;
  for (double weight = std::min(1.0, options.model_weight);;) {
    const ScaledEquations equations{layout, start.friction,
                                    weight / gauge_std_rad, s0, gauge_std_rad};
    converged = Minimise(equations, options.max_iterations, linear_solver,
                         &state, contact, &result.iterations);
    if (weight == options.model_weight || !state.AllFinite()) break;
    weight = std::min(100 * weight, options.model_weight);
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
