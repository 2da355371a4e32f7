#ifndef FINRAY_LADDER_LADDER_WALK_BACK_H_
#define FINRAY_LADDER_LADDER_WALK_BACK_H_

#include "finray/ladder/ladder_frame.h"
#include "finray/ladder/lanes.h"

namespace finray {
inline namespace FINRAY_ISA {

// The rows of a sweep (ladder_kernel.h) and its end, the walk back through its
// exchanges. A row holds the change of one quantity as [parameters | constant |
// derivatives] and is kVectors vectors long (0: as long as the frame says).
template <class T, int kVectors>
class LadderWalkBack {
 public:
  LadderWalkBack(LadderFrame<T>* frame, SweepColumns columns)
      : f_(*frame), columns_(columns) {}

  // Walks from the tip, where no parameter is left, back to the base. The rows
  // of `parameters` hold their values in the columns [constant | derivatives].
  void Run() {
    const bool nodes = columns_ != SweepColumns::kContacts;
    for (int j = 0; j < 6; ++j) Clear(f_.parameters + j * stride());
    for (int i = f_.event_count - 1; i >= 0; --i) {
      const int index = f_.events[i] / 4;
      switch (f_.events[i] % 4) {
        case kNode:
          if (nodes) FinishNode(index);
          break;
        case kTap:
          FinishRow(Tap(index));
          break;
        case kPivot:
          UndoExchange(index);
          break;
      }
    }
    for (int j = 0; j < 6; ++j) {
      Copy(f_.parameters + j * stride(), f_.q_step + j * stride());
    }
    if (!nodes) return;
    const int load = kAffine + 1;
    for (int i = 0; i < 6 + f_.ribs; ++i) {
      f_.step.q[i] = f_.q_step[i * stride() + kAffine];
      if (by_load()) f_.by_load.q[i] = f_.q_step[i * stride() + load];
    }
    FinishBases(&f_.step);
    if (by_load()) FinishBases(&f_.by_load);
  }

  // The same for one combination of the columns, the frame's `newton` and
  // `change`.
  void Combine() {
    const int derivatives = 2 * f_.contact_count;
    T with[kMostNodeColumns] = {};  // parameters, newton, change
    with[kAffine] = f_.newton;
    for (int k = 0; k < derivatives; ++k) with[kAffine + 1 + k] = f_.change[k];
    LadderNodes<T>& step = f_.step;
    for (int i = f_.event_count - 1; i >= 0; --i) {
      const int event = f_.events[i] % 4, index = f_.events[i] / 4;
      if (event == kNode) FinishNodeWith(with, &step, index);
      if (event != kPivot) continue;
      const T* g = f_.pivots + index * stride();
      const int column = f_.pivot_column[index];
      const T exchanged = with[column];
      if (f_.pivot_rib[index] >= 0) step.q[6 + f_.pivot_rib[index]] = exchanged;
      T sum = f_.pivot_flexibility[index] * exchanged;
      with[column] = T{};
      for (int k = 0; k <= kAffine + derivatives; ++k) sum -= g[k] * with[k];
      with[column] = sum / g[column];
    }
    for (int j = 0; j < 6; ++j) step.q[j] = with[j];
    FinishBases(&step);
  }

 protected:
  using V = typename Lanes<T>::Vector;
  using U = typename Lanes<T>::Unaligned;
  static constexpr int kWidth = Lanes<T>::kWidth;
  // The frame logs the events of the walk as 4 * index + one of these.
  enum Event { kNode, kTap, kPivot };

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

  bool by_load() const { return columns_ == SweepColumns::kLoad; }

  LadderFrame<T>& f_;
  const SweepColumns columns_;

 private:
  // The column of the constant, and the first vector that has values.
  static constexpr int kAffine = 6;
  static constexpr int first_value() { return kAffine / kWidth; }

  void FinishBases(LadderNodes<T>* z) const {
    for (int side = 0; side < 2; ++side) {
      const int base = f_.first(side);
      z->x[base] = z->y[base] = z->theta[base] = T{};
      z->moment[base] = z->q[3 * side];
      if (f_.clamps) z->theta[base] = f_.clamp[side] * z->q[3 * side];
    }
  }

  void FinishNode(int e) {
    T with[kMostNodeColumns] = {};
    for (int column = kAffine; column <= kAffine + by_load(); ++column) {
      for (int j = 0; j < 6; ++j) {
        with[j] = f_.parameters[j * stride() + column];
      }
      with[column] = T(1);
      if (column > kAffine) with[kAffine] = T{};
      FinishNodeWith(with, column == kAffine ? &f_.step : &f_.by_load, e);
    }
  }

  // The change of node e: its columns times `with`.
  void FinishNodeWith(const T* with, LadderNodes<T>* z, int e) const {
    const T* kept = Node(e);
    T change[4];
    for (int i = 0; i < 4; ++i) {
      V sum = V{};
      for (int v = 0; v < f_.node_columns / kWidth; ++v) {
        sum += Wide(kept + stride() * i)[v] * Wide(with)[v];
      }
      change[i] = sum[0];
      for (int lane = 1; lane < kWidth; ++lane) change[i] += sum[lane];
    }
    z->x[e] = change[0];
    z->y[e] = change[1];
    z->theta[e] = change[2];
    z->moment[e] = change[3];
  }

  void FinishRow(T* row) const {
    V by[6];
    for (int j = 0; j < 6; ++j) by[j] = Broadcast(row[j]);
    for (int v = first_value(); v < vectors(); ++v) {
      V sum = Wide(row)[v];
      for (int j = 0; j < 6; ++j) {
        sum += by[j] * Wide(f_.parameters + j * stride())[v];
      }
      Wide(row)[v] = sum;
    }
  }

  void UndoExchange(int pivot) {
    const T* g = f_.pivots + pivot * stride();
    const int column = f_.pivot_column[pivot];
    T* exchanged = f_.parameters + column * stride();
    if (f_.pivot_rib[pivot] >= 0) {
      Copy(exchanged, f_.q_step + (6 + f_.pivot_rib[pivot]) * stride());
    }
    const V kappa = Broadcast(f_.pivot_flexibility[pivot]);
    const V inverse = Broadcast(T(1) / g[column]);
    for (int v = first_value(); v < vectors(); ++v) {
      V sum = kappa * Wide(exchanged)[v] - Wide(g)[v];
      for (int j = 0; j < 6; ++j) {
        if (j != column) {
          sum -= Broadcast(g[j]) * Wide(f_.parameters + j * stride())[v];
        }
      }
      Wide(exchanged)[v] = sum * inverse;
    }
  }
};

}  // namespace FINRAY_ISA
}  // namespace finray

#endif  // FINRAY_LADDER_LADDER_WALK_BACK_H_
