#ifndef FINRAY_LADDER_LADDER_NEWTON_H_
#define FINRAY_LADDER_LADDER_NEWTON_H_

#include <vector>

#include "finray/ladder/ladder.h"
#include "finray/ladder/ladder_kernel.h"
#include "finray/ladder/ladder_workspace.h"

namespace finray {

enum class MeshChange {
  kNone,
  kRefined,  ///< The state is interpolated and to be converged anew.
  kTooFine,  ///< Would be finer than any load that a finger bears asks for.
};

/// Newton's method on the lifted ladder from wherever it stands, at a share of
/// a load. Where the discretization is adaptive the mesh is refined until the
/// series converge. Nothing is allocated but by the first call, by more
/// contacts than before and by refinement.
class LadderNewton {
 public:
  LadderNewton(const Finger& finger, const Discretization& discretization);

  LadderModel& model() { return model_; }
  const LadderModel& model() const { return model_; }
  const LadderWorkspace<double>& workspace() const { return workspace_; }
  const LadderFrame<double>& frame() const { return workspace_.frame(); }

  /// Convergence of loads and shape, relative; see EquilibriumSolver.
  void set_tolerance(double relative) { tolerance_ = relative; }

  /// Back to the undeformed finger and the mesh of the beginning.
  void Reset();
  void Load(const LadderState& state);
  void Save(LadderState* state) const { workspace_.Save(model_, state); }

  /// Solves at `fraction` of the load (forces and prestress). False if there is
  /// no convergence; the state is then anything. `columns` are the derivatives
  /// that taps and q_step of the frame shall hold afterwards; the state is
  /// Newton's last, and `step` what was added to it.
  bool Converge(const std::vector<PointContact>& contacts, double fraction,
                SweepColumns columns);

  /// Fills the slots of the frame at the present state under the whole load.
  bool Evaluate(const std::vector<PointContact>& contacts);
  /// Of the last Converge: how far the node that turned most has turned, rad,
  /// and the most iterations that a mesh took.
  double turn() const { return turn_; }
  int longest_run() const { return longest_run_; }

  /// One linearisation at the present state, without a step; kLoad. False if
  /// the system is singular or a number is not finite.
  bool Linearize(const std::vector<PointContact>& contacts, double fraction);
  /// As Linearize at the whole load, with derivatives by l_c and f_c of each
  /// contact (at most kFittedContacts) and the gauges read: taps are filled, no
  /// step is. False as above.
  bool LinearizeByContacts(const std::vector<PointContact>& contacts);
  /// Fills `step` after that: `newton` times Newton's step, with each contact's
  /// (l_c, f_c) moved by `change` in units of the workspace.
  void StepWithContacts(double newton, const double* change);

  /// state += a * step + b * by_load.
  void Move(double a, double b);
  /// Largest change of a node in a * step + b * by_load: angles in rad,
  /// positions in l_0.
  double Size(double a, double b) const;

  /// Refines where the last evaluation's series had not converged.
  MeshChange RefineMesh();

  /// All of q as unknowns and no gaps: fills the taps at base loads and
  /// tensions `q`, as FindLadderKernel's open_sweep. False if not finite.
  bool Shoot(const Eigen::VectorXd& q,
             const std::vector<PointContact>& contacts);

  /// Iterations since the last call.
  int TakeIterations();

 private:
  bool SetLoad(const std::vector<PointContact>& contacts, double fraction,
               SweepColumns columns, bool open);
  double LoadChange() const;
  bool IsConverged(int iteration, double size, double change,
                   double last_change) const;
  bool ConvergeOnMesh(const std::vector<PointContact>& contacts,
                      double fraction, SweepColumns columns);

  Discretization discretization_;
  LadderModel model_;
  std::array<BeamMesh, 2> first_mesh_;
  bool refined_ = false;
  LadderWorkspace<double> workspace_;
  const LadderKernel* kernel_;
  double tolerance_ = 1e-14;
  int iterations_ = 0, longest_run_ = 0;
  double turn_ = 0;
  std::vector<double> angles_before_;
};

}  // namespace finray

#endif  // FINRAY_LADDER_LADDER_NEWTON_H_
