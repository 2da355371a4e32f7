#ifndef FINRAY_LADDER_LADDER_WORKSPACE_H_
#define FINRAY_LADDER_LADDER_WORKSPACE_H_

#include <vector>

#include "finray/ladder/ladder.h"
#include "finray/ladder/ladder_frame.h"

namespace finray {

/// The memory of a ladder frame and the way into and out of its units. Memory
/// is taken when the mesh changes or more contacts or columns than ever before
/// are asked for; otherwise no call allocates. T is double, float or
/// FourFrames, all of which then take the same numbers unless a lane is named.
template <class T>
class LadderWorkspace {
 public:
  explicit LadderWorkspace(const LadderModel& model);
  LadderWorkspace(const LadderWorkspace& other);
  LadderWorkspace& operator=(const LadderWorkspace&) = delete;

  LadderFrame<T>& frame() { return frame_; }
  const LadderFrame<T>& frame() const { return frame_; }

  // Units: l_0, EI_0 / l_0^2 with EI_0 of ForceUnit() at construction.
  double length_unit() const { return length_unit_; }
  double force_unit() const { return force_unit_; }
  double moment_unit() const { return force_unit_ * length_unit_; }
  double stiffness_unit() const { return moment_unit() * length_unit_; }

  /// Takes up a changed mesh; the state is undefined after it.
  void SetMesh(const LadderModel& model);
  /// Takes up stiffness and rib lengths, these `fraction` of the way from
  /// nominal to those given.
  void SetFinger(const LadderModel& model, double fraction = 1);
  /// Takes up `fraction` of the load. False if a contact is not on its beam or
  /// a number is not finite.
  bool SetContacts(const LadderModel& model,
                   const std::vector<PointContact>& contacts,
                   double fraction = 1);
  /// Lays out the columns of the next sweep; kLoad and kNone are as wide as
  /// each other. `open`: all of q as parameters. True if that took more memory:
  /// what was evaluated or set since SetMesh is lost then, but for the state.
  bool SetColumns(const LadderModel& model, SweepColumns columns, bool open);

  void Load(const LadderState& state, int lane = kAllLanes);
  void Save(const LadderModel& model, LadderState* state, int lane = 0) const;
  static constexpr int kAllLanes = -1;

 private:
  void Allocate();
  void SetMeshMemory(const LadderModel& model);
  template <class Take>
  void LayOut(Take&& take);

  double length_unit_, force_unit_;
  LadderFrame<T> frame_;
  int contact_capacity_ = 0, stride_capacity_ = 8;
  // 32 bytes, of that alignment.
  struct alignas(32) Cell {
    T numbers[32 / sizeof(T)];
  };
  std::vector<Cell> cells_;
  std::vector<int> integers_;
  std::vector<LadderReadout<T>> readouts_;
  std::vector<LadderContact<T>> contacts_;
  std::vector<double> nominal_mm_;  // rib lengths without prestress
};

}  // namespace finray

#endif  // FINRAY_LADDER_LADDER_WORKSPACE_H_
