#include "finray/statics/equilibrium.h"

#include <algorithm>
#include <cmath>

#include "finray/finger/geometry.h"

namespace finray {
namespace {

// In units of l_0, EI / l_0 and EI / l_0^2. Newton's last step squares what is
// below this, so the equilibrium left behind is good to rounding.
constexpr double kTolerance = 1e-9;
constexpr int kMaxIterations = 25;
// A node that turns further than this in one step has left the linear range.
constexpr double kMaxTurn_rad = 0.7;
// A residual this large (a turn or a length many times the finger) is lost.
constexpr double kHopeless = 1e6;
constexpr double kSmallestRampStep = 1e-3;

}  // namespace

EquilibriumSolver::EquilibriumSolver(const Finger& finger,
                                     const Discretization& discretization)
    : model_(finger, discretization), scheme_(discretization.scheme) {
  const int n = model_.unknowns(), r = model_.ribs();
  const double length = finger.front_length_mm;
  const double force = ForceUnit(finger);
  row_unit_.setConstant(n, 1 / length);  // rib lengths, tip x and y
  row_unit_[r + 2] = 1;                  // tip angle
  row_unit_[r + 3] = 1 / (force * length);
  row_unit_.tail<2>().setConstant(1 / force);
  column_unit_.setConstant(n, force);
  column_unit_[0] = column_unit_[3] = force * length;
  Reset();
}

bool EquilibriumSolver::Solve(const std::vector<PointContact>& contacts) {
  return SolveFrom(contacts, false);
}

bool EquilibriumSolver::SolveWithSensitivities(
    const std::vector<PointContact>& contacts) {
  return SolveFrom(contacts, true);
}

bool EquilibriumSolver::SolveFrom(const std::vector<PointContact>& contacts,
                                  bool sensitivities) {
  iterations_ = 0;
  for (const PointContact& contact : contacts) {
    // Written so that a NaN fails.
    if (!(contact.arc_mm >= 0 &&
          contact.arc_mm <= model_.finger().front_length_mm)) {
      Reset();
      return false;
    }
  }
  if (SolveFromHere(contacts, sensitivities)) return true;
  Reset();
  if (SolveFromHere(contacts, sensitivities)) return true;
  if (SolveAlongRamp(contacts) && SolveFromHere(contacts, sensitivities)) {
    return true;
  }
  Reset();
  return false;
}

bool EquilibriumSolver::SolveAlongRamp(
    const std::vector<PointContact>& contacts) {
  std::vector<PointContact> ramped = contacts;
  const Finger target = model_.finger();
  const auto solve_at = [&](double fraction) {
    for (std::size_t i = 0; i < contacts.size(); ++i) {
      ramped[i].normal_N = fraction * contacts[i].normal_N;
    }
    for (int i = 0; i < model_.ribs(); ++i) {
      const double nominal = NominalRibLength(target, target.ribs[i]);
      model_.set_rib_length(
          i, nominal + fraction * (target.ribs[i].length_mm - nominal));
    }
    const bool solved = SolveFromHere(ramped, false);
    for (int i = 0; i < model_.ribs(); ++i) {
      model_.set_rib_length(i, target.ribs[i].length_mm);
    }
    return solved;
  };

  Reset();
  LadderState reached = state_;
  double fraction = 0, step = 0.25;
  while (fraction < 1) {
    const double next = std::min(1.0, fraction + step);
    if (solve_at(next)) {
      fraction = next;
      reached = state_;
      step *= 1.5;
    } else {
      state_ = reached;
      step *= 0.5;
      if (step < kSmallestRampStep) return false;
    }
  }
  return true;
}

bool EquilibriumSolver::SolveFromHere(const std::vector<PointContact>& contacts,
                                      bool sensitivities) {
  double best = kHopeless;
  for (int i = 0; i < kMaxIterations; ++i) {
    ++iterations_;
    March(model_, contacts, scheme_, MarchMode::kLifted, sensitivities, &state_,
          &linearization_);
    const double residual = ResidualNorm();
    // Written so that a NaN fails.
    if (!(residual <= kHopeless)) return false;
    if (!ComputeStep()) return false;
    if (residual < kTolerance) {
      ReduceOutputs(sensitivities);
      ApplyStep(1);
      return true;
    }
    // Newton may climb for a while; it does not come back from far above.
    best = std::min(best, residual);
    if (i > 8 && residual > 1e3 * best) return false;
    const double turn = LargestTurn();
    if (!std::isfinite(turn)) return false;
    ApplyStep(turn > kMaxTurn_rad ? kMaxTurn_rad / turn : 1.0);
  }
  return false;
}

double EquilibriumSolver::ResidualNorm() const {
  double norm = linearization_.defect;
  for (int i = 0; i < model_.unknowns(); ++i) {
    const double scaled = std::abs(linearization_.closure[i]) * row_unit_[i];
    if (!(scaled <= norm)) norm = scaled;
  }
  return norm;
}

// Solves the closure equations, with the defects closed as well, for the step
// in q; with sensitivities also for the response of q to each parameter.
bool EquilibriumSolver::ComputeStep() {
  const int n = model_.unknowns();
  const LadderLinearization& at = linearization_;
  scaled_ = row_unit_.asDiagonal() * at.d_closure.leftCols(n) *
            column_unit_.asDiagonal();
  lu_.compute(scaled_);
  step_ = -(at.closure + at.d_closure.rightCols<1>());
  step_.array() *= row_unit_.array();
  step_ = lu_.solve(step_);
  step_.array() *= column_unit_.array();
  return step_.allFinite();
}

double EquilibriumSolver::LargestTurn() const {
  double largest = 0;
  const int n = model_.unknowns();
  for (const auto& d : linearization_.d_nodes) {
    for (int row = 2; row < d.rows(); row += 4) {
      const double turn =
          std::abs(d.row(row).head(n).dot(step_) + d(row, d.cols() - 1));
      if (!(turn <= largest)) largest = turn;
    }
  }
  return largest;
}

void EquilibriumSolver::ApplyStep(double fraction) {
  const int n = model_.unknowns();
  for (int side = 0; side < 2; ++side) {
    const auto& d = linearization_.d_nodes[side];
    node_step_.noalias() = d.leftCols(n) * step_;
    node_step_ += d.col(d.cols() - 1);
    Eigen::Map<Eigen::VectorXd>(state_.nodes[side].data(), d.rows()) +=
        fraction * node_step_;
  }
  state_.q += fraction * step_;
}

void EquilibriumSolver::ReduceOutputs(bool sensitivities) {
  const LadderLinearization& at = linearization_;
  const int n = model_.unknowns();
  const int p = at.parameters;
  const int r = model_.ribs();
  outputs_ = at.outputs + at.d_outputs.col(at.columns() - 1);
  outputs_.noalias() += at.d_outputs.leftCols(n) * step_;
  if (!sensitivities) return;

  parameter_response_.resize(n, p + r);
  parameter_response_.leftCols(p) = -at.d_closure.middleCols(n, p);
  parameter_response_.rightCols(r).setZero();
  for (int i = 0; i < r; ++i) {
    // closure = |r| - L (1 + T / EA)
    parameter_response_(i, p + i) =
        1 + state_.q[6 + i] / model_.finger().ribs[i].axial_stiffness_N;
  }
  parameter_response_.array().colwise() *= row_unit_.array();
  d_q_ = lu_.solve(parameter_response_);
  d_q_.array().colwise() *= column_unit_.array();
  d_outputs_.resize(at.outputs.size(), p + r);
  d_outputs_.noalias() = at.d_outputs.leftCols(n) * d_q_;
  d_outputs_.leftCols(p) += at.d_outputs.middleCols(n, p);
}

std::array<std::vector<BeamSpan>, 2> EquilibriumSolver::Spans(
    const std::vector<PointContact>& contacts) const {
  LadderState state = state_;
  LadderLinearization linearization;
  std::array<std::vector<BeamSpan>, 2> spans;
  March(model_, contacts, scheme_, MarchMode::kLifted, false, &state,
        &linearization, &spans);
  return spans;
}

}  // namespace finray
