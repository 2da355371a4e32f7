#include "finray/chain/sensing.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "finray/chain/finger_jacobian.h"
#include "finray/chain/forward.h"
#include "finray/chain/newton_step.h"

namespace finray {
namespace {

constexpr double kMaxSensingTurn = 0.5;
constexpr double kMaxMove = 0.03;   // of l_0
constexpr double kMaxChange = 0.3;  // of f_c + F_0
constexpr double kSmallSensingStep = 1e-9;

// The pseudo-inverse step of (18) in units of the columns. It is subtracted:
// the printed plus would lead away.
Eigen::VectorXd Step(const ChainLayout& layout, const ChainUnits& units,
                     const Eigen::VectorXd& s0, double model_weight,
                     const ChainState& state, const ChainContact& contact) {
  const int n = layout.joints(), model = n + layout.loads();
  const int m = static_cast<int>(s0.size());
  const double at[2] = {contact.arc_mm, contact.normal_N};
  const Eigen::VectorXd row_weight = model_weight * units.rows.cwiseInverse();
  Eigen::VectorXd c(model + m);
  c.head(model) =
      FingerEquations<double>(layout, state.theta.data(), state.loads.data(),
                              at, contact.friction)
          .cwiseProduct(row_weight);
  c.tail(m) = layout.gauges * state.theta - s0;
  Eigen::MatrixXd jacobian = Eigen::MatrixXd::Zero(model + m, model + 2);
  jacobian.topRows(model) =
      row_weight.asDiagonal() *
      FingerJacobian(layout, state.theta.data(), state.loads.data(), at,
                     contact.friction) *
      units.columns.asDiagonal();
  jacobian.bottomLeftCorner(m, n) = layout.gauges;
  if (!c.allFinite() || !jacobian.allFinite()) {
    return Eigen::VectorXd::Constant(model + 2, std::nan(""));
  }
  return -jacobian.colPivHouseholderQr().solve(c);
}

}  // namespace

bool StartSensing(const ChainLayout& layout, const Eigen::VectorXd& s0,
                  const ChainContact& start, ChainSensing* result) {
  result->contact = start;
  const bool started = SolveForward(layout, start, &result->state);
  result->misfit = layout.gauges * result->state.theta - s0;
  return started && s0.allFinite();
}

ChainSensing SenseContact(const ChainLayout& layout, const Eigen::VectorXd& s0,
                          const ChainContact& start,
                          const ChainSensingOptions& options) {
  const int n = layout.joints(), loads = layout.loads();
  const ChainUnits units(layout);
  ChainSensing result;
  if (!StartSensing(layout, s0, start, &result)) return result;

  ChainState state = result.state;
  ChainContact contact = start;
  while (result.iterations < options.max_iterations) {
    ++result.iterations;
    const Eigen::VectorXd step =
        Step(layout, units, s0, options.model_weight, state, contact);
    if (!step.allFinite()) break;
    const double fraction =
        std::min({1.0, kMaxSensingTurn / LargestTurn(step.head(n)),
                  kMaxMove / std::abs(step[n + loads]),
                  kMaxChange * (1 + contact.normal_N / layout.force_unit_N) /
                      std::abs(step[n + loads + 1])});
    const Eigen::VectorXd change = fraction * step.cwiseProduct(units.columns);
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
