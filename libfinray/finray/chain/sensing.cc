#include "finray/chain/sensing.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "finray/chain/forward.h"
#include "finray/chain/scaled_equations.h"

namespace finray {
namespace {

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

}  // namespace

bool StartSensing(const ChainLayout& layout, const Eigen::VectorXd& s0,
                  const PointContact& start, ChainSensing* result) {
  result->contact = start;
  const bool started = SolveForward(layout, start, &result->state);
  result->misfit = layout.gauges * result->state.theta - s0;
  return started && s0.allFinite();
}

ChainSensing SenseContact(const ChainLayout& layout, const Eigen::VectorXd& s0,
                          const PointContact& start,
                          const ChainSensingOptions& options) {
  const int n = layout.joints(), loads = layout.loads();
  const ScaledEquations equations{layout, start.friction, options.model_weight,
                                  s0};
  const Eigen::VectorXd units = equations.ColumnUnits();
  ChainSensing result;
  if (!StartSensing(layout, s0, start, &result)) return result;

  ChainState state = result.state;
  PointContact contact = start;
  while (result.iterations < options.max_iterations) {
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

}  // namespace finray
