#ifndef FINRAY_STATICS_EQUILIBRIUM_H_
#define FINRAY_STATICS_EQUILIBRIUM_H_

#include <Eigen/Core>
#include <Eigen/LU>
#include <array>
#include <vector>

#include "finray/statics/ladder.h"

namespace finray {

/// Solves the ladder (ladder.h) for given loads: full Newton steps from the
/// present state, from the undeformed finger if that fails, and along a ramp of
/// the loads and of the assembly prestress if that fails too.
///
/// The solver keeps its state between calls, so a log is solved warm; it holds
/// all memory it needs after the first call with a number of contacts.
class EquilibriumSolver {
 public:
  EquilibriumSolver(const Finger& finger, const Discretization& discretization);

  LadderModel& model() { return model_; }
  const LadderModel& model() const { return model_; }

  const LadderState& state() const { return state_; }
  void set_state(const LadderState& state) { state_ = state; }
  /// Back to the undeformed finger: the next solve is a cold one.
  void Reset() { state_ = LadderState::Undeformed(model_); }

  /// Finds the equilibrium under `contacts`. False if none was found, or if a
  /// contact lies off the beam; the
  /// state is then the undeformed finger's and the results are not to be used.
  bool Solve(const std::vector<PointContact>& contacts);
  /// As Solve, and fills the derivatives below.
  bool SolveWithSensitivities(const std::vector<PointContact>& contacts);

  // Results of the last successful solve. Arc lengths, forces and so on as in
  // LadderLinearization.

  double gauge_angle(int gauge) const { return outputs_[gauge]; }
  /// (x, y, theta) of a contact in mm and rad.
  Eigen::Vector3d contact_pose(int contact) const {
    return outputs_.segment<3>(model_.gauges() + 3 * contact);
  }
  Eigen::Vector3d tip_pose() const { return outputs_.tail<3>(); }
  double rib_tension(int rib) const { return state_.q[6 + rib]; }
  /// Moment and force that the clamp exerts on a base, (M, F_x, F_y).
  Eigen::Vector3d base_reaction(Side side) const {
    return -state_.q.segment<3>(3 * LadderModel::Index(side));
  }

  /// [gauge angles (m); contact (x, y, theta) each; tip (x, y, theta)].
  const Eigen::VectorXd& outputs() const { return outputs_; }
  /// Their derivatives at equilibrium, by the implicit function theorem:
  /// dy/dp - dy/dq (dc/dq)^-1 dc/dp with c the closure equations. Columns
  /// [l_c, f_c of each contact; EI front; EI back; rib lengths (r)].
  const LadderLinearization::Matrix& d_outputs() const { return d_outputs_; }
  /// The same for the unknowns q (base reactions are their negatives).
  const LadderLinearization::Matrix& d_q() const { return d_q_; }

  /// Newton iterations of the last solve, all attempts together.
  int iterations() const { return iterations_; }

  /// The pieces of both beams at the present state, for drawing and integrals.
  std::array<std::vector<BeamSpan>, 2> Spans(
      const std::vector<PointContact>& contacts) const;
  Scheme scheme() const { return scheme_; }

 private:
  bool SolveFromHere(const std::vector<PointContact>& contacts,
                     bool sensitivities);
  bool SolveAlongRamp(const std::vector<PointContact>& contacts);
  bool SolveFrom(const std::vector<PointContact>& contacts, bool sensitivities);
  double ResidualNorm() const;
  bool ComputeStep();
  double LargestTurn() const;
  void ApplyStep(double fraction);
  void ReduceOutputs(bool sensitivities);

  LadderModel model_;
  Scheme scheme_;
  LadderState state_;
  LadderLinearization linearization_;
  Eigen::VectorXd row_unit_, column_unit_;
  Eigen::MatrixXd scaled_;
  Eigen::PartialPivLU<Eigen::MatrixXd> lu_;
  Eigen::VectorXd step_, node_step_;
  Eigen::MatrixXd parameter_response_;  // -(dc/dq)^-1 dc/dp
  Eigen::VectorXd outputs_;
  LadderLinearization::Matrix d_outputs_, d_q_;
  int iterations_ = 0;
};

}  // namespace finray

#endif  // FINRAY_STATICS_EQUILIBRIUM_H_
