#ifndef FINRAY_LADDER_LADDER_H_
#define FINRAY_LADDER_LADDER_H_

#include <Eigen/Core>
#include <array>
#include <utility>
#include <vector>

#include "finray/finger/discretization.h"
#include "finray/finger/finger.h"
#include "finray/finger/mesh.h"
#include "finray/finger/point_contact.h"
#include "finray/ladder/element.h"

namespace finray {

// The finger as a ladder: both beams are marched from base to tip, rung by
// rung. At a rib both hinges are known, so its direction is explicit,
// u = (r_R - r_L) / |r_R - r_L|, and its tension T makes the internal forces
// jump:
//
//   N_front+ = N_front- - T u,    N_back+ = N_back- + T u.
//
// Springs at its hinges, or a rib that bends, add jumps of moment and a
// transverse force (finger.h, rib_law.h).
// A contact force F makes N jump to N+ = N- - F on its beam. If it acts on a
// surface at a height h above the beam, the moment of its friction makes M jump
// too. A clamp with compliance turns by it times M. The march leaves 6 + r
// unknowns,
//
//   q = (M, N_x, N_y at the front base; the same at the back base; T_1 .. T_r)
//
// and as many closure equations: r rib lengths, |r_R - r_L| = L (1 + T / EA),
// equation (7) of the paper, less what bending shortens; and six at the tip,
// where position, angle, moment and force of both beams must agree.
//
// The state at every mesh node is an unknown too (multiple shooting): a Newton
// step then starts each element near its true state. A march from the base
// alone would be a cantilever under the full load. ladder_kernel.h has the
// step.

/// A finger cut into elements. Stiffness and rib lengths may be changed between
/// solves (calibration does).
class LadderModel {
 public:
  /// Throws InputError if the scheme cannot model the finger or its ribs cross,
  /// have no length or are at a base or the tip.
  LadderModel(const Finger& finger, const Discretization& discretization);

  const Finger& finger() const { return finger_; }
  const BeamMesh& mesh(Side side) const { return mesh_[Index(side)]; }
  int ribs() const { return static_cast<int>(finger_.ribs.size()); }
  int gauges() const { return static_cast<int>(finger_.gauges.size()); }
  int unknowns() const { return 6 + ribs(); }

  void set_stiffness(double front_N_mm2, double back_N_mm2) {
    finger_.front_stiffness_N_mm2 = front_N_mm2;
    finger_.back_stiffness_N_mm2 = back_N_mm2;
  }
  void set_rib_length(int rib, double length_mm) {
    finger_.ribs[rib].length_mm = length_mm;
  }
  /// Derivatives are carried by these parameters of the finger too, in this
  /// order, and behind them by the friction coefficient of all contacts. All
  /// are statics effects.
  void set_effects(std::vector<FingerParameter> effects,
                   bool by_friction = false) {
    effects_ = std::move(effects);
    by_friction_ = by_friction;
    moves_nodes_ = false;
    for (const FingerParameter& effect : effects_) {
      moves_nodes_ |= MovesNodes(effect.kind);
    }
  }
  bool by_friction() const { return by_friction_; }
  /// Says that nodes of the mesh move with an effect.
  bool moves_nodes() const { return moves_nodes_; }
  int effect_columns() const {
    return static_cast<int>(effects_.size()) + by_friction_;
  }
  const std::vector<FingerParameter>& effects() const { return effects_; }
  /// The place of the first effect of a kind among effects(); -1 if none is.
  int EffectOf(FingerParameterKind kind) const;
  /// The place of an effect among effects(); -1 if it is none of them.
  int EffectOf(const FingerParameter& effect) const;
  /// Sets the value of an effect. False if no finger can have it.
  bool set_effect(int effect, double value);
  /// Takes other nodes for the same ribs and pieces.
  void set_mesh(const std::array<BeamMesh, 2>& mesh) { mesh_ = mesh; }

  static int Index(Side side) { return side == Side::kFront ? 0 : 1; }

 private:
  bool MoveTo(const FingerParameter& effect, double value);

  Finger finger_;
  std::array<BeamMesh, 2> mesh_;
  std::vector<FingerParameter> effects_;
  bool by_friction_ = false, moves_nodes_ = false;
};

/// The unknowns of an equilibrium.
struct LadderState {
  Eigen::VectorXd q;  ///< base moments and forces, rib tensions (6 + r).
  /// (s, x, y, theta, M) at the start of each element, front and back, in mm,
  /// rad and N mm.
  using Nodes = Eigen::Matrix<double, 5, Eigen::Dynamic>;
  std::array<Nodes, 2> nodes;
  std::array<std::vector<int>, 2> rib_node;  ///< As in BeamMesh.
  std::array<double, 2> length_mm = {};      ///< Of the beams.

  /// The undeformed, unloaded finger.
  static LadderState Undeformed(const LadderModel& model);
  /// Whether the state was saved on the model's mesh.
  bool IsOnMeshOf(const LadderModel& model) const;
};

/// A smooth piece of a deformed beam. Its element gives any point of it.
struct BeamSpan {
  double arc_mm;
  double length_mm;
  double x_mm, y_mm;
  ElementStart start;
  double stiffness_N_mm2;
  double axial_flexibility_per_N;
};

}  // namespace finray

#endif  // FINRAY_LADDER_LADDER_H_
