#ifndef FINRAY_STATICS_EQUILIBRIUM_H_
#define FINRAY_STATICS_EQUILIBRIUM_H_

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "finray/statics/load_path.h"
#include "finray/statics/load_trail.h"

namespace finray {

/// The result of one march of the ladder from base to tip with given base loads
/// and rib tensions, which need not be in equilibrium.
struct LadderShot {
  using Matrix =
      Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  /// How far the closure equations (ladder.h) are from zero: rib lengths (r),
  /// then x, y, theta, M, N_x, N_y of front against back beam at the tip.
  Eigen::VectorXd closure;
  /// [gauge angles (m); contact (x, y, theta) each; tip (x, y, theta)].
  Eigen::VectorXd outputs;
  /// Their derivatives by [q (6 + r); l_c, f_c of each contact; EI front; EI
  /// back; rib lengths (r); effects of the model].
  Matrix d_closure, d_outputs;
};

/// Start here: the face of the physics. Finds the equilibrium of a finger under
/// point contacts, and the derivatives of gauge angles, contact poses and tip.
///
/// Newton's method (ladder.h has the equations) starts from the present state.
/// If it fails it starts from the undeformed finger, and then it follows the
/// path of growing loads and assembly prestress (load_path.h). High loads may
/// have several equilibria; then only the path or a near start is trusted.
///
/// The solver keeps its last states (load_trail.h), so each frame of a log
/// starts near its solution. Such a warm solve allocates nothing.
class EquilibriumSolver {
 public:
  using Matrix = LadderShot::Matrix;

  /// Throws InputError if the scheme cannot model the finger, or if ribs cross,
  /// have no length or lie at a base or the tip.
  EquilibriumSolver(const Finger& finger, const Discretization& discretization);

  LadderModel& model() { return newton_.model(); }
  const LadderModel& model() const { return newton_.model(); }
  Scheme scheme() const { return scheme_; }

  /// The error at which Newton's method stops: of base loads and tensions
  /// relative to the largest one, of angles in rad. The default 1e-14 means to
  /// rounding; 1e-6 saves an iteration or two.
  void set_tolerance(double relative) { newton_.set_tolerance(relative); }

  /// With this, a solve only looks for an equilibrium near the present state. A
  /// missing equilibrium is then found out a hundred times faster.
  void set_near_only(bool near_only) { near_only_ = near_only; }

  LadderState state() const;
  /// The same without allocating.
  void SaveState(LadderState* state) const { newton_.Save(state); }
  void set_state(const LadderState& state);
  /// Goes back to the undeformed finger: the next solve starts cold.
  void Reset();

  /// Finds the equilibrium under `contacts`. If it returns false, status() and
  /// Why() say why; the state is then the undeformed finger and the results are
  /// undefined.
  bool Solve(const std::vector<PointContact>& contacts) {
    return SolveFor(contacts, SweepColumns::kNone);
  }
  /// As Solve, and fills d_outputs().
  bool SolveWithSensitivities(const std::vector<PointContact>& contacts) {
    return SolveFor(contacts, SweepColumns::kParameters);
  }

  /// Finds the equilibrium under up to kFittedContacts contacts, and fills the
  /// columns [l_c, f_c of each contact] of d_outputs(). Each solve of a
  /// sequence starts from the tangent at the solve before.
  bool SolveByContacts(const std::vector<PointContact>& contacts) {
    return SolveFor(contacts, SweepColumns::kContacts);
  }

  SolveStatus status() const { return status_; }
  /// Why the last solve failed, one clause; empty if it did not.
  std::string Why() const;
  /// The share of the load at which the load path ended.
  double path_fraction() const { return path_fraction_; }

  // Results of the last successful solve. A gauge angle is in rad.

  double gauge_angle(int gauge) const { return outputs_[gauge]; }
  /// (x, y, theta) of a contact in mm and rad.
  Eigen::Vector3d contact_pose(int contact) const {
    return outputs_.segment<3>(model().gauges() + 3 * contact);
  }
  Eigen::Vector3d tip_pose() const { return outputs_.tail<3>(); }
  /// In N; tension > 0.
  double rib_tension(int rib) const;

  /// [gauge angles (m); contact (x, y, theta) each; tip (x, y, theta)].
  const Eigen::VectorXd& outputs() const { return outputs_; }
  /// Derivatives of outputs() at equilibrium by the implicit function theorem,
  /// columns [l_c, f_c of each contact; EI front; EI back; rib lengths (r);
  /// effects of the model], or the first of them (SolveByContacts).
  const Matrix& d_outputs() const { return d_outputs_; }

  /// Newton iterations of the last solve, all attempts together.
  int iterations() const { return iterations_; }

  /// The number of unknowns of the last solve: six base loads, rib tensions and
  /// four a node.
  int unknowns() const;

  /// The pieces of both beams at the present state, for Shape. Two threads must
  /// not call it at once: it uses the solver's scratch memory.
  std::array<std::vector<BeamSpan>, 2> Spans(
      const std::vector<PointContact>& contacts) const;

  /// Marches from base to tip with the base loads and tensions `q`. False if
  /// the result is not finite or a rib bends too far (rib_law.h). It changes
  /// the state, which is then no equilibrium.
  bool Shoot(const Eigen::VectorXd& q,
             const std::vector<PointContact>& contacts, LadderShot* shot);

 private:
  bool SolveFor(const std::vector<PointContact>& contacts,
                SweepColumns columns);
  SolveStatus Attempt(const std::vector<PointContact>& contacts,
                      SweepColumns columns);
  bool ConvergeNear(const std::vector<PointContact>& contacts,
                    SweepColumns columns, bool heavy);
  bool Predict(const std::vector<PointContact>& contacts);
  bool Converge(const std::vector<PointContact>& contacts, SweepColumns columns,
                bool heavy, double turned = 0);
  bool IsBadLoad(const std::vector<PointContact>& contacts) const;
  bool IsHeavy(const std::vector<PointContact>& contacts) const;
  void CollectValues(bool stepped, Eigen::VectorXd* outputs);
  void OutputUnits();
  void AddTaps(int first, int count, Matrix* target) const;

  Scheme scheme_;
  mutable LadderNewton newton_;  // Spans() uses its scratch memory
  LoadTrail trail_;
  bool undeformed_ = true, near_only_ = false;
  SolveStatus status_ = SolveStatus::kSolved;
  double path_fraction_ = 0;
  int iterations_ = 0;
  Eigen::VectorXd outputs_;
  Eigen::VectorXd output_unit_, parameter_unit_, q_unit_;
  Matrix d_outputs_;
};

}  // namespace finray

#endif  // FINRAY_STATICS_EQUILIBRIUM_H_
