#ifndef FINRAY_LADDER_LADDER_WORKSPACE_H_
#define FINRAY_LADDER_LADDER_WORKSPACE_H_

#include <vector>

#include "finray/ladder/ladder.h"
#include "finray/ladder/ladder_frame.h"

namespace finray {

/// The memory of a LadderFrame and the conversion to and from its units. A call
/// allocates only when the mesh changes or when it asks for more contacts or
/// columns than ever before. T is double or float.
template <class T>
class LadderWorkspace {
 public:
  explicit LadderWorkspace(const LadderModel& model);
  LadderWorkspace(const LadderWorkspace& other);
  LadderWorkspace& operator=(const LadderWorkspace&) = delete;

  LadderFrame<T>& frame() { return frame_; }
  const LadderFrame<T>& frame() const { return frame_; }

  // Units: l_0 and F_0 = ForceUnit() at construction.
  double length_unit() const { return length_unit_; }
  double force_unit() const { return force_unit_; }
  double moment_unit() const { return force_unit_ * length_unit_; }
  double stiffness_unit() const { return moment_unit() * length_unit_; }

  /// Takes up a changed mesh; the state is undefined after it.
  void SetMesh(const LadderModel& model);
  /// Takes up stiffness and rib lengths. The lengths are `fraction` of the way
  /// from nominal to those of the finger.
  void SetFinger(const LadderModel& model, double fraction = 1);
  /// Takes up `fraction` of the contact forces and lays out the columns of the
  /// next sweep (SetColumns). False if a contact is not on its beam or a number
  /// is not finite. More memory loses everything evaluated, except the state.
  bool SetContacts(const LadderModel& model,
                   const std::vector<PointContact>& contacts,
                   double fraction = 1,
                   SweepColumns columns = SweepColumns::kNone,
                   bool open = false);
  /// Lays out columns, no more than those of the last SetContacts; those of
  /// kLoad and kNone have the same width. `open` is for all of q as parameters.
  void SetColumns(SweepColumns columns, bool open);

  /// Puts the bases where base loads and clamps hold them.
  void SetBases();
  void Load(const LadderState& state);
  void Save(const LadderModel& model, LadderState* state) const;

 private:
  void SetEffects(const LadderModel& model);
  void SetPieces(const LadderModel& model);
  void SetBeamEffects(const LadderModel& model);
  void PlaceReadouts(const LadderModel& model);
  void PlaceNodes(const LadderModel& model);
  void SetMotion(const LadderModel& model);
  void SetBayMotion(const LadderModel& model, Side side);
  void Allocate();
  template <class Take>
  void LayOut(Take&& take);

  double length_unit_, force_unit_;
  LadderFrame<T> frame_;
  int contact_capacity_ = 0, stride_capacity_ = 8;
  // The widest vector with its alignment.
  struct alignas(64) Cell {
    T numbers[64 / sizeof(T)];
  };
  std::vector<Cell> cells_;
  std::vector<int> integers_;
  std::vector<LadderReadout<T>> readouts_;
  std::vector<LadderContact<T>> contacts_;
  std::vector<double> nominal_mm_;  // Rib lengths without prestress.
};

}  // namespace finray

#endif  // FINRAY_LADDER_LADDER_WORKSPACE_H_
