#ifndef FINRAY_LADDER_LADDER_LANES_H_
#define FINRAY_LADDER_LADDER_LANES_H_

#include <array>

#include "finray/ladder/ladder.h"
#include "finray/ladder/ladder_kernel.h"
#include "finray/ladder/ladder_workspace.h"

namespace finray {

/// A set of lanes, one bit each.
using LaneSet = unsigned;
constexpr LaneSet kAllFrameLanes = (1u << kFrameLanes) - 1;
inline bool Has(LaneSet set, int lane) { return (set >> lane & 1u) != 0; }

/// LadderNewton's linearisations for four frames side by side, each with one
/// contact on the front beam, on the mesh that a discretization begins with.
///
/// The lanes share mesh, pivots and the order of what lies on a beam. So that
/// contacts may lie in two different elements, both of these have a contact,
/// and a lane whose own is in the other one has none (`present`) where the
/// element begins or ends: a piece of no length, which changes nothing.
class LadderLanes {
 public:
  /// Throws InputError as LadderModel.
  LadderLanes(const Finger& finger, const Discretization& discretization,
              double friction);

  const LadderModel& model() const { return model_; }
  const LadderWorkspace<FourFrames>& workspace() const { return workspace_; }
  const LadderFrame<FourFrames>& frame() const { return workspace_.frame(); }

  /// Of one lane. Load returns false if the state has another mesh.
  bool Load(const LadderState& state, int lane);
  void Save(LadderState* state, int lane) const {
    workspace_.Save(model_, state, lane);
  }

  /// Takes up a contact for each of the lanes `wanted` and returns those lanes
  /// that can be solved together, `first` ones before others. The rest rides
  /// along without a contact.
  LaneSet Place(const std::array<double, kFrameLanes>& arc_mm,
                const std::array<double, kFrameLanes>& normal_N, LaneSet wanted,
                LaneSet first);
  /// The number of the contact that is lane's own.
  int contact_of(int lane) const { return contact_of_[lane]; }

  /// Linearises with derivatives by (l_c, f_c) and readings. False if singular
  /// or not finite in any lane.
  bool Linearize();
  /// After that: adds to the state `newton` times Newton's step (0 or 1, lane
  /// by lane) with the contacts moved by `change` of (l_c, f_c) in units of the
  /// workspace.
  void Step(const FourFrames& newton, const FourFrames change[2]);

  /// Number of values that make up a state, which begin at frame().state.q.
  int state_size() const { return 6 + frame().ribs + 4 * frame().elements; }

 private:
  static constexpr int kMostContacts = 2;

  LadderModel model_;
  LadderWorkspace<FourFrames> workspace_;
  const LadderKernel* kernel_;
  double friction_;
  std::array<int, kFrameLanes> contact_of_{};
};

}  // namespace finray

#endif  // FINRAY_LADDER_LADDER_LANES_H_
