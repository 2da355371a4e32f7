#ifndef FINRAY_LADDER_LADDER_H_
#define FINRAY_LADDER_LADDER_H_

#include <Eigen/Core>
#include <array>
#include <vector>

#include "finray/finger/discretization.h"
#include "finray/finger/finger.h"
#include "finray/finger/mesh.h"
#include "finray/finger/point_contact.h"
#include "finray/ladder/element.h"

namespace finray {

// The finger as a ladder: both beams are marched from base to tip, rung by
// rung. At a rib both hinges are known, so its direction u = (r_R - r_L) / |r_R
// - r_L| is explicit and its tension T makes the internal forces jump,
//
//   N_front+ = N_front- - T u,    N_back+ = N_back- + T u,
//
// as a contact force F makes N+ = N- - F on its beam. What remains to be solved
// are the 6 + r unknowns
//
//   q = (M, N_x, N_y at the front base; the same at the back base; T_1 .. T_r)
//
// from as many closure equations: r rib lengths, |r_R - r_L| = L (1 + T / EA),
// which is (7) of the paper, and at the tip position, angle, moment and force
// of one beam against the other.
//
// The state at every mesh node is an unknown too ("lifted", multiple shooting):
// a Newton step then starts each element from a state near the truth, where
// shooting from the base would be a cantilever under the full load.
// ladder_kernel.h has the step.

/// Whether a beam has axial flexibility.
bool Stretches(const Finger& finger);

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
  /// Other nodes for the same ribs and pieces.
  void set_mesh(const std::array<BeamMesh, 2>& mesh);

  /// Where a gauge ends: its angle is the sum of sign * theta over both ends.
  struct GaugeEnd {
    int gauge;
    int sign;
    MeshPoint point;
  };
  /// The gauge ends on a beam in order of their arc lengths.
  const std::vector<GaugeEnd>& gauge_ends(Side side) const {
    return gauge_ends_[Index(side)];
  }

  static int Index(Side side) { return side == Side::kFront ? 0 : 1; }

 private:
  Finger finger_;
  std::array<BeamMesh, 2> mesh_;
  std::array<std::vector<GaugeEnd>, 2> gauge_ends_;
};

/// The unknowns of an equilibrium.
struct LadderState {
  Eigen::VectorXd q;  ///< base moments and forces, rib tensions (6 + r).
  /// (s, x, y, theta, M) at the start of each element, front and back.
  using Nodes = Eigen::Matrix<double, 5, Eigen::Dynamic>;
  std::array<Nodes, 2> nodes;

  /// The undeformed, unloaded finger.
  static LadderState Undeformed(const LadderModel& model);
};

/// A piece of a beam between stations, from which any point of it follows.
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
