#ifndef FINRAY_LADDER_LADDER_ROWS_H_
#define FINRAY_LADDER_LADDER_ROWS_H_

#include "finray/ladder/ladder_frame.h"
#include "finray/ladder/lanes.h"

namespace finray {
inline namespace FINRAY_ISA {

// The rows of a sweep (ladder_sweep.h) and its walk back. A row holds the
// change of one quantity as [parameters | constant | derivatives] and is
// kVectors vectors long (0: as long as the frame says).
template <class T, int kVectors>
class LadderRows {
 protected:
  using Scalar = typename ValueTraits<T>::Scalar;
  using V = typename Lanes<T>::Vector;
  using U = typename Lanes<T>::Unaligned;
  static constexpr int kWidth = Lanes<T>::kWidth;
  // The frame logs the events of the walk as 4 * index + one of these.
  enum Event { kNode, kTap, kPivot };

  explicit LadderRows(LadderFrame<T>* frame) : f_(*frame) {}

  int vectors() const { return kVectors > 0 ? kVectors : f_.stride / kWidth; }
  int stride() const { return vectors() * kWidth; }
  // Four rows of a node: position, angle and moment.
  T* Node(int e) const { return f_.node_rows + 4 * stride() * e; }
  T* Tap(int tap) const { return f_.taps + tap * stride(); }

  static V Broadcast(const T& value) { return value - V{}; }
  static U* Wide(T* row) { return reinterpret_cast<U*>(row); }
  static const U* Wide(const T* row) { return reinterpret_cast<const U*>(row); }
  void Clear(T* row) const {
    for (int v = 0; v < vectors(); ++v) Wide(row)[v] = V{};
  }
  void Copy(const T* from, T* to) const {
    for (int v = 0; v < vectors(); ++v) Wide(to)[v] = Wide(from)[v];
  }
  // to += a from
  void Add(const T& a, const T* from, T* to) const {
    const V wide = Broadcast(a);
    for (int v = 0; v < vectors(); ++v) Wide(to)[v] += wide * Wide(from)[v];
  }

  LadderFrame<T>& f_;
};

}  // namespace FINRAY_ISA
}  // namespace finray

#endif  // FINRAY_LADDER_LADDER_ROWS_H_
