#ifndef FINRAY_STATICS_LADDER_H_
#define FINRAY_STATICS_LADDER_H_

#include <Eigen/Core>
#include <array>
#include <vector>

#include "finray/finger/finger.h"
#include "finray/finger/mesh.h"
#include "finray/statics/discretization.h"
#include "finray/statics/element.h"

namespace finray {

// The finger as a ladder: both beams are marched from base to tip, rung by
// rung. At a rib both hinges are known, so its direction u = (r_R - r_L) / |r_R
// - r_L| is explicit and its tension T makes the internal forces jump,
//
//   N_front+ = N_front- - T u,    N_back+ = N_back- + T u,
//
// as a contact force F makes N_front+ = N_front- - F. What remains to be solved
// are the 6 + r unknowns
//
//   q = (M, N_x, N_y at the front base; the same at the back base; T_1 .. T_r)
//
// from as many closure equations: r rib lengths, |r_R - r_L| = L (1 + T / EA),
// which is (7) of the paper, and at the tip position, angle, moment and force
// of one beam against the other.
//
// The state at every mesh node is kept as an unknown too ("lifted", multiple
// shooting): a Newton step then starts each element from a state near the
// truth, where shooting from the base would be a cantilever under the full
// load.

/// A point force on the front beam: normal_N along the local normal
/// (sin(theta), -cos(theta)), into the finger, plus friction * normal_N along
/// the tangent, towards the tip.
struct PointContact {
  double arc_mm = 0;
  double normal_N = 0;
  double friction = 0;
};

/// A finger cut into elements. Stiffness and rib lengths may be changed between
/// solves (calibration does); everything else is fixed with the mesh.
class LadderModel {
 public:
  LadderModel(const Finger& finger, const Discretization& discretization);

  const Finger& finger() const { return finger_; }
  const BeamMesh& mesh(Side side) const { return mesh_[Index(side)]; }
  double stiffness(Side side) const {
    return side == Side::kFront ? finger_.front_stiffness_N_mm2
                                : finger_.back_stiffness_N_mm2;
  }
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

  /// Where a gauge ends: its angle is the sum of sign * theta over both ends.
  struct GaugeEnd {
    int gauge;
    double sign;
    MeshPoint point;
  };
  /// The gauge ends on a beam in order of their elements.
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
  /// (x, y, theta, M) at the start of each element, front and back.
  std::array<Eigen::Matrix4Xd, 2> nodes;

  /// The undeformed, unloaded finger.
  static LadderState Undeformed(const LadderModel& model);
};

/// Everything the march yields, with derivatives by columns
/// [q (6 + r) | l_c, f_c of each contact | EI front, EI back | defects], of
/// which the last is the change that closing all node defects would make.
/// Without sensitivities the middle two groups are absent.
struct LadderLinearization {
  using Matrix =
      Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  int unknowns = 0;
  int parameters = 0;
  int columns() const { return unknowns + parameters + 1; }

  /// Rib lengths (r), then tip x, y, theta, M, N_x, N_y of front against back.
  Eigen::VectorXd closure;
  Matrix d_closure;
  /// Gauge angles (m), then (x, y, theta) of each contact, then of the tip.
  Eigen::VectorXd outputs;
  Matrix d_outputs;
  /// Four rows a node, front and back.
  std::array<Matrix, 2> d_nodes;
  /// Largest gap between an element's end and the next node's state, lengths in
  /// units of l_0, moments in units of EI / l_0.
  double defect = 0;

  // The march's own memory, kept so that a warm march allocates nothing.
  struct Scratch {
    /// Derivatives of (x, y, theta, M, N_x, N_y) carried along each beam.
    std::array<Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::RowMajor>, 2>
        carried;
    Eigen::RowVectorXd across_rib;
    std::vector<int> contact_order;
  } scratch;
};

/// A piece of a beam between stations, from which any point of it follows.
struct BeamSpan {
  double arc_mm;
  double length_mm;
  double x_mm, y_mm;
  ElementStart start;
};

/// What happens to the stored node states during the march.
enum class MarchMode {
  kLifted,     ///< Elements start from them; the gaps are reported as defects.
  kPropagate,  ///< They are overwritten by what reaches them; there are no
               ///< gaps.
};

/// Marches both beams at `state` under `contacts` and fills `out`, whose memory
/// is reused. Contacts are taken in any order; arc lengths must lie on the
/// beam. `spans`, if given, receives the pieces of both beams.
void March(const LadderModel& model, const std::vector<PointContact>& contacts,
           Scheme scheme, MarchMode mode, bool sensitivities,
           LadderState* state, LadderLinearization* out,
           std::array<std::vector<BeamSpan>, 2>* spans = nullptr);

}  // namespace finray

#endif  // FINRAY_STATICS_LADDER_H_
