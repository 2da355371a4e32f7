#ifndef FINRAY_STATICS_EQUILIBRIUM_H_
#define FINRAY_STATICS_EQUILIBRIUM_H_

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "finray/ladder/ladder_newton.h"

namespace finray {

/// How a solve ended.
enum class SolveStatus {
  kSolved,
  kBadLoad,     ///< A contact off its beam, or a number that is not finite.
  kLimitPoint,  ///< The equilibrium that grows out of the unloaded finger ends
                ///< (folds over) before the whole load is reached.
  kNotConverged,
};

/// Closure equations of the ladder at base loads and tensions that need not be
/// in equilibrium, every node being where the march from the base puts it.
struct LadderShot {
  using Matrix =
      Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  /// Rib lengths (r), then tip x, y, theta, M, N_x, N_y of front against back.
  Eigen::VectorXd closure;
  /// [gauge angles (m); contact (x, y, theta) each; tip (x, y, theta)].
  Eigen::VectorXd outputs;
  /// By [q (6 + r); l_c, f_c of each contact; EI front; EI back; rib lengths].
  Matrix d_closure, d_outputs;
};

/// Finds the equilibrium of a finger under point contacts: full Newton steps
/// from the present state, from the undeformed finger if that fails, and along
/// the path of growing loads and assembly prestress if that fails too. Under
/// loads so high that several equilibria may exist only the path is trusted, or
/// a state that is near already.
///
/// The solver keeps its state between calls, so a log is solved warm; a warm
/// solve allocates nothing.
class EquilibriumSolver {
 public:
  using Matrix = LadderShot::Matrix;

  /// Throws InputError if the scheme cannot model the finger or its ribs cross,
  /// have no length or are at a base or the tip.
  EquilibriumSolver(const Finger& finger, const Discretization& discretization);

  LadderModel& model() { return newton_.model(); }
  const LadderModel& model() const { return newton_.model(); }
  Scheme scheme() const { return scheme_; }

  /// How far Newton's method goes: an estimate of the error that is left, of
  /// base loads and tensions relative to the largest, of angles in rad. By
  /// default 1e-14, that is to rounding; 1e-6 saves an iteration or two.
  void set_tolerance(double relative) { newton_.set_tolerance(relative); }

  LadderState state() const;
  /// The same without an allocation.
  void SaveState(LadderState* state) const;
  void set_state(const LadderState& state);
  /// Back to the undeformed finger: the next solve is a cold one.
  void Reset();

  /// Finds the equilibrium under `contacts`. If false, status() and Why() say
  /// why not; the state is then the undeformed finger's and the results are not
  /// to be used.
  bool Solve(const std::vector<PointContact>& contacts);
  /// As Solve, and fills the derivatives below.
  bool SolveWithSensitivities(const std::vector<PointContact>& contacts);

  SolveStatus status() const { return status_; }
  /// One clause for people; empty if solved.
  std::string Why() const;
  /// The share of the load at which the path ended, if it did.
  double path_fraction() const { return path_fraction_; }

  // Results of the last successful solve.

  double gauge_angle(int gauge) const { return outputs_[gauge]; }
  /// (x, y, theta) of a contact in mm and rad.
  Eigen::Vector3d contact_pose(int contact) const {
    return outputs_.segment<3>(model().gauges() + 3 * contact);
  }
  Eigen::Vector3d tip_pose() const { return outputs_.tail<3>(); }
  double rib_tension(int rib) const;
  /// Moment and force that the clamp exerts on a base, (M, F_x, F_y).
  Eigen::Vector3d base_reaction(Side side) const;

  /// [gauge angles (m); contact (x, y, theta) each; tip (x, y, theta)].
  const Eigen::VectorXd& outputs() const { return outputs_; }
  /// Their derivatives at equilibrium, by the implicit function theorem.
  /// Columns [l_c, f_c of each contact; EI front; EI back; rib lengths (r)].
  const Matrix& d_outputs() const { return d_outputs_; }
  /// The same for the unknowns q of ladder.h (base reactions are their
  /// negatives).
  const Matrix& d_q() const { return d_q_; }

  /// Newton iterations of the last solve, all attempts together.
  int iterations() const { return iterations_; }

  /// Unknowns of the last solve: six base loads, rib tensions and four a node.
  int unknowns() const;

  /// The pieces of both beams at the present state, for drawing and integrals.
  /// It uses the solver's scratch memory: not from two threads at once.
  std::array<std::vector<BeamSpan>, 2> Spans(
      const std::vector<PointContact>& contacts) const;

  /// Evaluates the closure equations at `q`. False if they are not finite. The
  /// solver is left at the shot, so that status() is no longer kSolved.
  bool Shoot(const Eigen::VectorXd& q,
             const std::vector<PointContact>& contacts, LadderShot* shot);

 private:
  bool SolveFor(const std::vector<PointContact>& contacts,
                SweepColumns columns);
  bool Attempt(const std::vector<PointContact>& contacts, SweepColumns columns);
  bool IsBadLoad(const std::vector<PointContact>& contacts) const;
  bool IsHeavy(const std::vector<PointContact>& contacts) const;
  void CollectValues();
  void CollectDerivatives();
  void OutputUnits();
  void AddTaps(int first, int count, Matrix* target) const;

  Scheme scheme_;
  mutable LadderNewton newton_;  // Spans() uses its scratch memory
  bool undeformed_ = true;
  SolveStatus status_ = SolveStatus::kSolved;
  double path_fraction_ = 0;
  int iterations_ = 0;
  Eigen::VectorXd outputs_;
  Eigen::VectorXd output_unit_, parameter_unit_, q_unit_;
  Matrix d_outputs_, d_q_;
};

}  // namespace finray

#endif  // FINRAY_STATICS_EQUILIBRIUM_H_
