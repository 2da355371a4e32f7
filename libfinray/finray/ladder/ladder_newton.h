#ifndef FINRAY_LADDER_LADDER_NEWTON_H_
#define FINRAY_LADDER_LADDER_NEWTON_H_

#include <vector>

#include "finray/ladder/ladder.h"
#include "finray/ladder/ladder_kernel.h"
#include "finray/ladder/ladder_workspace.h"

namespace finray {

enum class MeshChange {
  kNone,
  kRefined,  ///< The state is interpolated and must be converged again.
  kTooFine,  ///< The mesh would be finer than any bearable load needs.
};

/// Newton's method on the ladder (ladder.h) from its present state, at a share
/// of a load. If the discretization is adaptive, the mesh is refined until the
/// series converge. Only the first call, more contacts than ever before and
/// refinement allocate memory.
class LadderNewton {
 public:
  LadderNewton(const Finger& finger, const Discretization& discretization);

  LadderModel& model() { return model_; }
  const LadderModel& model() const { return model_; }
  const LadderWorkspace<double>& workspace() const { return workspace_; }
  const LadderFrame<double>& frame() const { return workspace_.frame(); }

  /// The relative error of loads and shape; see EquilibriumSolver.
  void set_tolerance(double relative) { tolerance_ = relative; }

  /// Goes back to the undeformed finger and the first mesh.
  void Reset();
  /// Takes up a state and its mesh. Throws InputError if the state belongs to a
  /// finger with another number of ribs.
  void Load(const LadderState& state);
  void Save(LadderState* state) const { workspace_.Save(model_, state); }

  /// Solves at `fraction` of the load (forces and prestress). Returns false if
  /// it does not converge; the state is then undefined. Afterwards taps and
  /// q_step of the frame hold the derivatives `columns`, and `step` holds the
  /// last step, which is already added to the state. kContacts is for at most
  /// kFittedContacts.
  bool Converge(const std::vector<PointContact>& contacts, double fraction,
                SweepColumns columns);

  /// After Converge with kContacts: moves the state along the tangent to where
  /// the contacts, as many as before, are expected to take it. Returns false
  /// and leaves the state if anything else has happened since, or if a node
  /// would turn too far for a linearisation.
  bool FollowTangent(const std::vector<PointContact>& contacts);

  /// Fills the slots of the frame at the present state under the whole load.
  /// False if a number is not finite.
  bool Evaluate(const std::vector<PointContact>& contacts);
  /// After Converge: the angle by which the node that turned most has turned,
  /// in rad, and the most iterations that one mesh took.
  double turn() const { return turn_; }
  int longest_run() const { return longest_run_; }

  /// Linearises at the present state by the load and takes no step: fills
  /// `step` and `by_load`. False if the system is singular or a number is not
  /// finite.
  bool Linearize(const std::vector<PointContact>& contacts, double fraction);

  /// state += a * step + b * by_load.
  void Move(double a, double b);
  /// The largest change of a node in a * step + b * by_load: angles in rad,
  /// positions in l_0.
  double Size(double a, double b) const;

  /// Refines the elements whose series had not converged at the last
  /// evaluation.
  MeshChange RefineMesh();

  /// Marches from base to tip with the base loads and tensions `q` and fills
  /// the taps with all of q as unknowns (LadderKernel::open_sweep). False if a
  /// number is not finite.
  bool Shoot(const Eigen::VectorXd& q,
             const std::vector<PointContact>& contacts);

  /// The iterations since the last call of this function.
  int TakeIterations();

 private:
  bool SetLoad(const std::vector<PointContact>& contacts, double fraction,
               SweepColumns columns, bool open = false);
  double LoadChange() const;
  bool IsConverged(int iteration, double size, double change,
                   double last_change) const;
  bool ConvergeOnMesh(const std::vector<PointContact>& contacts,
                      double fraction, SweepColumns columns);

  Discretization discretization_;
  LadderModel model_;
  const LadderState undeformed_;
  LadderWorkspace<double> workspace_;
  const LadderKernel* kernel_;
  double tolerance_ = 1e-14;
  int iterations_ = 0, longest_run_ = 0;
  double turn_ = 0;
  std::vector<double> angles_before_;
  // The contacts of the last Converge; empty where the frame does not hold its
  // tangent any more.
  std::vector<PointContact> tangent_of_;
};

}  // namespace finray

#endif  // FINRAY_LADDER_LADDER_NEWTON_H_
