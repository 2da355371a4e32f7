#ifndef FINRAY_LADDER_LADDER_WALK_BACK_H_
#define FINRAY_LADDER_LADDER_WALK_BACK_H_

#include "finray/ladder/ladder_rows.h"

namespace finray {
inline namespace FINRAY_ISA {

// The end of a sweep (ladder_kernel.h): the walk back through its exchanges.
template <class T, int kVectors>
class LadderWalkBack : private LadderRows<T, kVectors> {
  using Rows = LadderRows<T, kVectors>;
  using Rows::Broadcast, Rows::Clear, Rows::Copy, Rows::f_, Rows::kNode,
      Rows::kPivot, Rows::kTap, Rows::kWidth, Rows::Node, Rows::stride,
      Rows::Tap, Rows::vectors, Rows::Wide;
  using typename Rows::Scalar, typename Rows::V;

 public:
  LadderWalkBack(LadderFrame<T>* frame, SweepColumns columns)
      : Rows(frame), columns_(columns) {}

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
    for (int side = 0; side < 2; ++side) {
      const int base = side == 0 ? 0 : f_.front_elements;
      for (const LadderNodes<T>* z : {&f_.step, &f_.by_load}) {
        if (z == &f_.by_load && !by_load()) break;
        z->x[base] = z->y[base] = z->theta[base] = T{};
        z->moment[base] = z->q[3 * side];
      }
    }
  }

  // The same for one combination of the columns, the frame's `newton` and
  // `change`.
  void Combine(int derivatives) {
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
    for (int side = 0; side < 2; ++side) {
      const int base = side == 0 ? 0 : f_.front_elements;
      step.x[base] = step.y[base] = step.theta[base] = T{};
      step.moment[base] = step.q[3 * side];
    }
  }

 private:
  // The column of the constant, and the first vector that has values.
  static constexpr int kAffine = 6;
  static constexpr int first_value() { return kAffine / kWidth; }
  bool by_load() const { return columns_ == SweepColumns::kLoad; }

  void FinishNode(int e) {
    T with[kMostNodeColumns] = {};
    for (int column = kAffine; column <= kAffine + by_load(); ++column) {
      for (int j = 0; j < 6; ++j) {
        with[j] = f_.parameters[j * stride() + column];
      }
      with[column] = T{} + Scalar(1);
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
      change[i] = reinterpret_cast<const T*>(&sum)[0];
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
    const V inverse = Broadcast(Scalar(1) / g[column]);
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

  const SweepColumns columns_;
};

}  // namespace FINRAY_ISA
}  // namespace finray

#endif  // FINRAY_LADDER_LADDER_WALK_BACK_H_
