#ifndef FINRAY_LADDER_LADDER_LANES_H_
#define FINRAY_LADDER_LADDER_LANES_H_

#include <array>

#include "finray/ladder/ladder.h"
#include "finray/ladder/ladder_kernel.h"
#include "finray/ladder/ladder_workspace.h"

namespace finray {

/// A set of lanes, one bit each.
using LaneSet = unsigned;
template <class T>
constexpr LaneSet kAllFrameLanes = (1u << kFrameLanes<T>)-1;
inline bool Has(LaneSet set, int lane) { return (set >> lane & 1u) != 0; }

/// Linearises frames side by side as LadderNewton does one: four or eight, T
/// being FourFrames or EightFrames. Each frame has one contact on the front
/// beam; the mesh is the one that the discretization begins with.
///
/// The lanes share the mesh, the pivots and the order of contacts and gauge
/// ends on a beam. The contacts of the lanes may lie in two different elements.
/// Then every lane has a contact in both; the one that is not its own has no
/// force
/// (`present` is 0) and lies at the start or end of its element, where it cuts
/// off a piece of no length and changes nothing.
template <class T>
class LadderLanes {
 public:
  static constexpr int kLanes = kFrameLanes<T>;

  /// Throws InputError as LadderModel, and std::invalid_argument if this
  /// machine has no kernel for T (FindFramesKernel).
  LadderLanes(const Finger& finger, const Discretization& discretization,
              double friction);

  const LadderModel& model() const { return model_; }
  const LadderWorkspace<T>& workspace() const { return workspace_; }
  const LadderFrame<T>& frame() const { return workspace_.frame(); }

  /// Loads and saves one lane. Load returns false if the state has another
  /// mesh.
  bool Load(const LadderState& state, int lane);
  void Save(LadderState* state, int lane) const {
    workspace_.Save(model_, state, lane);
  }

  /// Places a contact for each of the lanes `wanted` and returns the lanes that
  /// can be solved together. Lanes in `first` are chosen before others. The
  /// other lanes are computed without a contact.
  LaneSet Place(const std::array<double, kLanes>& arc_mm,
                const std::array<double, kLanes>& normal_N, LaneSet wanted,
                LaneSet first);
  /// The number of the contact that is the lane's own.
  int contact_of(int lane) const { return contact_of_[lane]; }

  /// Linearises with derivatives by (l_c, f_c) and reads the gauges. False if
  /// any lane is singular or not finite.
  bool Linearize();
  /// After Linearize: adds `newton` times Newton's step (0 or 1 in each lane)
  /// to the state, with (l_c, f_c) moved by `change` in units of the workspace.
  void Step(const T& newton, const T change[2]);

 private:
  static constexpr int kMostContacts = 2;

  LadderModel model_;
  LadderWorkspace<T> workspace_;
  const FramesKernel<T>* kernel_;
  double friction_;
  std::array<int, kLanes> contact_of_{};
};

}  // namespace finray

#endif  // FINRAY_LADDER_LADDER_LANES_H_
