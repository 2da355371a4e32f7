#ifndef FINRAY_STATICS_LADDER_SWEEP_H_
#define FINRAY_STATICS_LADDER_SWEEP_H_

#include "finray/statics/ladder_evaluate.h"

namespace finray {
inline namespace FINRAY_ISA {

// The second half of a Newton step (ladder_kernel.h). Rows hold the change of
// one quantity as [parameters | constant | derivatives], kVectors vectors long
// (0: as many as the frame says).
template <class T, int kVectors>
class LadderSweeper {
 public:
  using Scalar = typename ValueTraits<T>::Scalar;
  using V = typename Lanes<T>::Vector;
  using U = typename Lanes<T>::Unaligned;
  static constexpr int kWidth = Lanes<T>::kWidth;

  LadderSweeper(LadderFrame<T>* frame, SweepColumns columns, bool open)
      : f_(*frame), columns_(columns), open_(open) {}

  // Without readouts their taps keep what they held.
  bool Run(bool readouts) {
    Begin();
    int at[2] = {0, f_.front_elements};
    for (int rib = 0; rib <= f_.ribs; ++rib) {
      for (int side = 0; side < 2; ++side) {
        const int end = rib < f_.ribs
                            ? f_.rib_element[side][rib]
                            : (side == 0 ? f_.front_elements : f_.elements);
        for (; at[side] < end; ++at[side]) {
          PassElement(side, at[side], readouts);
        }
        if (rib < f_.ribs) TakeUpGap(side, end);
      }
      if (rib < f_.ribs) PassRib(rib);
    }
    CloseTip();
    if (open_) return true;
    if (!EliminateTip()) return false;
    WalkBack();
    return true;
  }

  // The walk back once more, for the frame's `newton` and `change`.
  void Combine(int derivatives) {
    T with[kMostNodeColumns] = {};  // parameters, 1, change
    with[affine()] = f_.newton;
    for (int k = 0; k < derivatives; ++k) with[affine() + 1 + k] = f_.change[k];
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
      for (int k = 0; k <= affine() + derivatives; ++k) sum -= g[k] * with[k];
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
  enum Row { kX, kY, kTheta, kMoment, kForceX, kForceY, kRows };
  enum Event { kNode, kTap, kPivot };
  // Beyond this the parameters are exchanged: it costs as many digits of a
  // step, which Newton's next one corrects.
  static constexpr Scalar kLargestGrowth = 1000;
  static constexpr int kParameterVectors = (6 + kWidth - 1) / kWidth;

  int vectors() const { return kVectors > 0 ? kVectors : f_.stride / kWidth; }
  int stride() const { return vectors() * kWidth; }
  int affine() const { return open_ ? f_.affine : 6; }
  // The first vector that the walk back has values in.
  int first_value() const { return affine() / kWidth; }
  T* RowOf(int side, int row) const {
    return f_.rows + (kRows * side + row) * stride();
  }
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
  void Log(Event event, int index) { f_.events[events_++] = 4 * index + event; }

  bool parameters() const { return columns_ == SweepColumns::kParameters; }
  bool by_contacts() const {
    return parameters() || columns_ == SweepColumns::kContacts;
  }
  bool by_load() const { return columns_ == SweepColumns::kLoad; }
  int ContactColumn(int c) const {
    return affine() + 1 + 2 * f_.contacts[c].columns;
  }
  const T& Present(int c) const { return f_.contacts[c].present; }
  int StiffnessColumn(int side) const {
    return affine() + 1 + 2 * f_.contact_count + side;
  }
  int RibColumn(int rib) const {
    return affine() + 1 + 2 * f_.contact_count + 2 + rib;
  }

  void Begin() {
    while (next_contact_[1] < f_.contact_count &&
           f_.contacts[next_contact_[1]].side == 0) {
      ++next_contact_[1];
    }
    for (int i = 0; i < 2 * kRows; ++i) Clear(f_.rows + i * stride());
    for (int side = 0; side < 2; ++side) {
      for (int i = 0; i < 3; ++i) {
        RowOf(side, kMoment + i)[3 * side + i] += Scalar(1);
      }
    }
  }

  // The node at the start of element e: its stored state is off by the gap. At
  // a rib that happens before the rib is passed.
  void TakeUpGap(int side, int e) {
    if (gap_taken_[side] || e == (side == 0 ? 0 : f_.front_elements)) return;
    gap_taken_[side] = true;
    for (int i = 0; i < 4; ++i) RowOf(side, i)[affine()] += f_.gap[4 * e + i];
  }

  void KeepNode(int side, int e) {
    if (open_) return;
    T* kept = f_.node_rows + 4 * f_.node_columns * e;
    for (int i = 0; i < 4; ++i) {
      for (int v = 0; v < f_.node_columns / kWidth; ++v) {
        Wide(kept + f_.node_columns * i)[v] = Wide(RowOf(side, i))[v];
      }
    }
    Log(kNode, e);
  }

  void PassElement(int side, int e, bool readouts) {
    TakeUpGap(side, e);
    if (gap_taken_[side]) KeepNode(side, e);
    gap_taken_[side] = false;
    int slot = e, begins_at = -1;
    for (int& c = next_contact_[side];
         c < f_.contact_count && f_.contacts[c].element == e; ++c) {
      PassSlot(side, e, slot, begins_at, c, readouts);
      PassContact(side, c);
      begins_at = c;
      slot = f_.elements + c;
    }
    PassSlot(side, e, slot, begins_at, -1, readouts);
    if (!open_ && ++since_check_ >= kGrowthCheckEvery) CheckGrowth();
  }

  // A slot that begins (ends) at a contact becomes shorter (longer) when that
  // contact moves towards the tip.
  void PassSlot(int side, int e, int slot, int begins_at, int ends_at,
                bool readouts) {
    for (int i = f_.first_readout[slot]; readouts && i < f_.end_readout[slot];
         ++i) {
      TapReadout(side, i, begins_at, ends_at, e);
    }
    const T* map =
        f_.maps + (slot / kWidth) * kWidth * kMapValues + slot % kWidth;
    V a[4][4];
    for (int i = 0; i < 4; ++i) {
      for (int p = 0; p < 4; ++p) {
        a[i][p] = Broadcast(map[(kMapStart + 4 * i + p) * kWidth]);
      }
    }
    U* x = Wide(RowOf(side, kX));
    U* y = Wide(RowOf(side, kY));
    U* theta = Wide(RowOf(side, kTheta));
    U* moment = Wide(RowOf(side, kMoment));
    const U* fx = Wide(RowOf(side, kForceX));
    const U* fy = Wide(RowOf(side, kForceY));
    for (int v = 0; v < vectors(); ++v) {
      const V t = theta[v], m = moment[v], n = fx[v], w = fy[v];
      x[v] += a[0][0] * t + a[0][1] * m + a[0][2] * n + a[0][3] * w;
      y[v] += a[1][0] * t + a[1][1] * m + a[1][2] * n + a[1][3] * w;
      theta[v] = a[2][0] * t + a[2][1] * m + a[2][2] * n + a[2][3] * w;
      moment[v] = a[3][0] * t + a[3][1] * m + a[3][2] * n + a[3][3] * w;
    }
    if (!by_contacts()) return;
    for (int i = 0; i < 4; ++i) {
      T* row = RowOf(side, i);
      if (parameters()) {
        row[StiffnessColumn(side)] +=
            f_.stiffness_ratio[e] * map[(kMapStiffness + i) * kWidth];
      }
      const T& by_length = map[(kMapLength + i) * kWidth];
      if (begins_at >= 0) {
        row[ContactColumn(begins_at)] -= Present(begins_at) * by_length;
      }
      if (ends_at >= 0) {
        row[ContactColumn(ends_at)] += Present(ends_at) * by_length;
      }
    }
  }

  void TapReadout(int side, int i, int begins_at, int ends_at, int e) {
    const T* at = f_.readout_map + kReadoutValues * i;
    T* tap = Tap(f_.readout_tap(i));
    const V by[4] = {Broadcast(at[1]), Broadcast(at[2]), Broadcast(at[3]),
                     Broadcast(at[4])};
    const U* from = Wide(RowOf(side, kTheta));
    for (int v = 0; v < vectors(); ++v) {
      V sum = by[0] * from[v];
      for (int p = 1; p < 4; ++p) sum += by[p] * from[p * vectors() + v];
      Wide(tap)[v] = sum;
    }
    if (parameters()) {
      tap[StiffnessColumn(side)] += f_.stiffness_ratio[e] * at[5];
    }
    if (by_contacts()) {
      if (begins_at >= 0) {
        tap[ContactColumn(begins_at)] -= Present(begins_at) * (at[6] + at[7]);
      }
      if (ends_at >= 0) {
        tap[ContactColumn(ends_at)] += Present(ends_at) * at[7];
      }
    }
    Log(kTap, f_.readout_tap(i));
  }

  void TapPose(int side, int first) {
    for (int i = 0; i < 3; ++i) {
      Copy(RowOf(side, i), Tap(first + i));
      Log(kTap, first + i);
    }
  }

  // N+ = N- - f (n + mu t).
  void PassContact(int side, int c) {
    TapPose(side, f_.contact_tap(f_.contacts[c].index));
    const LadderContact<T>& contact = f_.contacts[c];
    T unit[2], turned[2];
    ContactDirection(contact, f_.slot_theta[f_.elements + c], unit, turned);
    for (int i = 0; i < 2; ++i) {
      T* force = RowOf(side, kForceX + i);
      Add(-contact.normal * turned[i], RowOf(side, kTheta), force);
      if (by_contacts()) {
        force[ContactColumn(c) + 1] -= contact.present * unit[i];
      }
      if (by_load()) force[affine() + 1] -= contact.d_normal * unit[i];
    }
  }

  void PassRib(int rib) {
    const T ux = f_.rib_ux[rib], uy = f_.rib_uy[rib];
    const T tension = f_.state.q[6 + rib];
    const T kappa = f_.rib_length[rib] * f_.rib_flexibility[rib];
    T* length =
        open_ ? Tap(f_.closure_tap() + rib) : f_.pivots + pivots_ * stride();
    const V wide_x = Broadcast(ux), wide_y = Broadcast(uy);
    const V swing = Broadcast(tension / f_.rib_distance[rib]);
    U* front_x = Wide(RowOf(0, kForceX));
    U* front_y = Wide(RowOf(0, kForceY));
    U* back_x = Wide(RowOf(1, kForceX));
    U* back_y = Wide(RowOf(1, kForceY));
    for (int v = 0; v < vectors(); ++v) {
      const V dx = Wide(RowOf(1, kX))[v] - Wide(RowOf(0, kX))[v];
      const V dy = Wide(RowOf(1, kY))[v] - Wide(RowOf(0, kY))[v];
      Wide(length)[v] = wide_x * dx + wide_y * dy;
      // T du = T / |r| (-u_y, u_x) times the motion across the rib
      const V across = swing * (wide_x * dy - wide_y * dx);
      front_x[v] += across * wide_y;
      front_y[v] -= across * wide_x;
      back_x[v] -= across * wide_y;
      back_y[v] += across * wide_x;
    }
    const T strained = Scalar(1) + tension * f_.rib_flexibility[rib];
    if (parameters()) length[RibColumn(rib)] -= strained;
    if (by_load()) length[affine() + 1] -= strained * f_.d_rib_length[rib];
    int column = 6 + rib;
    if (open_) {
      length[column] -= kappa;
    } else {
      length[affine()] += f_.closure[rib];
      column = LargestColumn(length);
      Exchange(column, kappa, rib, f_.rows, 2 * kRows);
    }
    RowOf(0, kForceX)[column] -= ux;
    RowOf(0, kForceY)[column] -= uy;
    RowOf(1, kForceX)[column] += ux;
    RowOf(1, kForceY)[column] += uy;
  }

  // By the lane in which it is smallest: all lanes share their pivots.
  static int LargestColumn(const T* row) {
    int column = 0;
    Scalar largest = SmallestLane(Magnitude(row[0]));
    for (int j = 1; j < 6; ++j) {
      const Scalar size = SmallestLane(Magnitude(row[j]));
      if (size > largest) {
        largest = size;
        column = j;
      }
    }
    return column;
  }

  // Exchanges parameter `column` for the quantity whose row is the next of
  // pivots, in `count` rows from `rows`.
  void Exchange(int column, const T& kappa, int rib, T* rows, int count) {
    const T* g = f_.pivots + pivots_ * stride();
    const T inverse = Scalar(1) / g[column];
    for (int i = 0; i < count; ++i) {
      T* row = rows + i * stride();
      const T factor = row[column] * inverse;
      Add(-factor, g, row);
      row[column] = factor * kappa;
    }
    f_.pivot_column[pivots_] = column;
    f_.pivot_flexibility[pivots_] = kappa;
    f_.pivot_rib[pivots_] = rib;
    Log(kPivot, pivots_);
    ++pivots_;
  }

  void CheckGrowth() {
    since_check_ = 0;
    V squares[kParameterVectors];
    for (V& v : squares) v = V{};
    for (int i = 0; i < 2 * kRows; ++i) {
      const U* row = Wide(f_.rows + i * stride());
      for (int v = 0; v < kParameterVectors; ++v) squares[v] += row[v] * row[v];
    }
    const T* of_column = reinterpret_cast<const T*>(squares);
    T largest = of_column[0];
    for (int j = 1; j < 6; ++j) largest = Larger(largest, of_column[j]);
    if (LargestLane(largest) > kLargestGrowth * kLargestGrowth) Reparametrize();
  }

  void Reparametrize() {
    bool used[6] = {};
    for (int k = 0; k < 6; ++k) {
      int pivot_row = 0, column = 0;
      Scalar largest = -1;
      for (int i = 0; i < 2 * kRows; ++i) {
        for (int j = 0; j < 6; ++j) {
          const Scalar size =
              SmallestLane(Magnitude(f_.rows[i * stride() + j]));
          // A row that was chosen is one in its own column, zero elsewhere.
          if (!used[j] && size > largest) {
            largest = size;
            pivot_row = i;
            column = j;
          }
        }
      }
      if (!(largest > 0)) return;
      used[column] = true;
      Copy(f_.rows + pivot_row * stride(), f_.pivots + pivots_ * stride());
      Exchange(column, T{} + Scalar(1), -1, f_.rows, 2 * kRows);
    }
  }

  // Geometry must agree; moments and forces must cancel.
  void CloseTip() {
    TapPose(0, f_.tip_tap());
    T* rows = open_ ? Tap(f_.closure_tap() + f_.ribs) : f_.tip_rows;
    for (int i = 0; i < kRows; ++i) {
      T* row = rows + i * stride();
      Copy(RowOf(0, i), row);
      Add(T{} + Scalar(i < kMoment ? -1 : 1), RowOf(1, i), row);
      if (!open_) row[affine()] += f_.closure[f_.ribs + i];
    }
  }

  bool EliminateTip() {
    for (int k = 0; k < 6; ++k) {
      const T* row = f_.tip_rows + k * stride();
      const int column = LargestColumn(row);
      // Written so that a NaN fails.
      if (!(SmallestLane(Magnitude(row[column])) > 0)) return false;
      Copy(row, f_.pivots + pivots_ * stride());
      Exchange(column, T{}, -1, f_.tip_rows + (k + 1) * stride(), 5 - k);
    }
    return true;
  }

  // From the tip, where no parameter is left, back to the base; `p` holds their
  // values [constant | derivatives] in columns from `affine` on.
  void WalkBack() {
    f_.event_count = events_;
    const bool nodes = columns_ != SweepColumns::kContacts;
    for (int j = 0; j < 6; ++j) Clear(f_.parameters + j * stride());
    while (events_ > 0) {
      const int event = f_.events[--events_];
      const int index = event / 4;
      switch (event % 4) {
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
    const int load = affine() + 1;
    for (int i = 0; i < 6 + f_.ribs; ++i) {
      f_.step.q[i] = f_.q_step[i * stride() + affine()];
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

  void FinishNode(int e) {
    T with[kMostNodeColumns] = {};
    for (int column = affine(); column <= affine() + by_load(); ++column) {
      for (int j = 0; j < 6; ++j) {
        with[j] = f_.parameters[j * stride() + column];
      }
      with[column] = T{} + Scalar(1);
      if (column > affine()) with[affine()] = T{};
      FinishNodeWith(with, column == affine() ? &f_.step : &f_.by_load, e);
    }
  }

  // The change of node e where columns are taken times `with`.
  void FinishNodeWith(const T* with, LadderNodes<T>* z, int e) const {
    const T* kept = f_.node_rows + 4 * f_.node_columns * e;
    T change[4];
    for (int i = 0; i < 4; ++i) {
      V sum = V{};
      for (int v = 0; v < f_.node_columns / kWidth; ++v) {
        sum += Wide(kept + f_.node_columns * i)[v] * Wide(with)[v];
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

  LadderFrame<T>& f_;
  const SweepColumns columns_;
  const bool open_;
  int events_ = 0, pivots_ = 0, since_check_ = 0;
  int next_contact_[2] = {0, 0};
  bool gap_taken_[2] = {false, false};
};

}  // namespace FINRAY_ISA
}  // namespace finray

#endif  // FINRAY_STATICS_LADDER_SWEEP_H_
