#ifndef FINRAY_LADDER_LADDER_SWEEP_H_
#define FINRAY_LADDER_LADDER_SWEEP_H_

#include "finray/ladder/ladder_evaluate.h"
#include "finray/ladder/ladder_rows.h"

namespace finray {
inline namespace FINRAY_ISA {

// Sweep, the second half of a Newton step (ladder_kernel.h): walks both beams
// from base to tip, and back (ladder_walk_back.h) unless the tip stays open.
template <class T, int kVectors>
class LadderSweeper : private LadderRows<T, kVectors> {
  using Rows = LadderRows<T, kVectors>;
  using Rows::Add, Rows::affine, Rows::Broadcast, Rows::by_contacts,
      Rows::by_load, Rows::Clear, Rows::columns_, Rows::ContactColumn,
      Rows::ContactNode, Rows::Copy, Rows::EffectColumn, Rows::f_, Rows::kNode,
      Rows::kPivot, Rows::kTap, Rows::kWidth, Rows::Node, Rows::node_,
      Rows::Lengthening, Rows::open_, Rows::parameters, Rows::PassJoints,
      Rows::PassSurface, Rows::TightenJoints, Rows::TurnBases, Rows::RibColumn,
      Rows::RowOf, Rows::StiffnessColumn, Rows::stride, Rows::Tap,
      Rows::TipNode, Rows::vectors, Rows::Wide;
  using Rows::kX, Rows::kY, Rows::kTheta, Rows::kMoment, Rows::kForceX,
      Rows::kForceY, Rows::kRows;
  using typename Rows::Event, typename Rows::U, typename Rows::V;

 public:
  LadderSweeper(LadderFrame<T>* frame, SweepColumns columns, bool open)
      : Rows(frame, columns, open) {}

  // Without `readouts` the taps of the gauges keep their old values.
  bool Run(bool readouts) {
    Begin();
    int at[2] = {0, f_.front_elements};
    for (int rib = 0; rib <= f_.ribs; ++rib) {
      for (int side = 0; side < 2; ++side) {
        const int end =
            rib < f_.ribs ? f_.rib_element[side][rib] : f_.end(side);
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
    f_.event_count = events_;
    Rows::Run();
    return true;
  }

 private:
  // Growth beyond this exchanges the parameters. Growth up to it costs three
  // digits of a step, which Newton's next step corrects.
  static constexpr T kLargestGrowth = 1000;
  static constexpr int kParameterVectors = (6 + kWidth - 1) / kWidth;

  void Log(Event event, int index) { f_.events[events_++] = 4 * index + event; }

  void Begin() {
    while (next_contact_[1] < f_.contact_count &&
           f_.contacts[next_contact_[1]].side == 0) {
      ++next_contact_[1];
    }
    node_[0] = Node(0);
    node_[1] = Node(f_.front_elements);
    for (int i = 0; i < 2 * kRows; ++i) Clear(RowOf(i));
    for (int side = 0; side < 2; ++side) {
      for (int i = 0; i < 3; ++i) {
        RowOf(side, kMoment + i)[3 * side + i] += T(1);
      }
    }
    TurnBases();
  }

  // Adds the gap at the node where element e starts. At a rib this happens
  // before the rib is passed.
  void TakeUpGap(int side, int e) {
    if (gap_taken_[side] || e == f_.first(side)) return;
    gap_taken_[side] = true;
    for (int i = 0; i < 4; ++i) RowOf(side, i)[affine()] += f_.gap[4 * e + i];
  }

  void PassElement(int side, int e, bool readouts) {
    TakeUpGap(side, e);
    if (gap_taken_[side] && !open_) Log(kNode, e);
    gap_taken_[side] = false;
    const bool last = e + 1 == f_.end(side);
    int slot = e, begins_at = -1;
    for (int& c = next_contact_[side];
         c < f_.contact_count && f_.contacts[c].element == e; ++c) {
      PassSlot(side, e, slot, begins_at, c, readouts, ContactNode(side));
      PassContact(side, c);
      begins_at = c;
      slot = f_.elements + c;
    }
    PassSlot(side, e, slot, begins_at, -1, readouts,
             last ? TipNode(side) : Node(e + 1));
    if (!open_ && ++since_check_ >= kGrowthCheckEvery) CheckGrowth();
  }

  // When a contact moves towards the tip, the slot that ends at it becomes
  // longer and the slot that begins at it shorter.
  void PassSlot(int side, int e, int slot, int begins_at, int ends_at,
                bool readouts, T* end) {
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
    const U* from[kRows];
    U* to[4];
    for (int i = 0; i < kRows; ++i) from[i] = Wide(RowOf(side, i));
    for (int i = 0; i < 4; ++i) to[i] = Wide(end + i * stride());
    for (int v = 0; v < vectors(); ++v) {
      const V t = from[kTheta][v], m = from[kMoment][v];
      const V n = from[kForceX][v], w = from[kForceY][v];
      for (int i = 0; i < 4; ++i) {
        const V moved = a[i][0] * t + a[i][1] * m + a[i][2] * n + a[i][3] * w;
        to[i][v] = i < kTheta ? from[i][v] + moved : moved;
      }
    }
    node_[side] = end;
    if (!by_contacts()) return;
    for (int i = 0; i < 4; ++i) {
      T* row = RowOf(side, i);
      if (parameters()) {
        AddStiffness(side, e, map[(kMapStiffness + i) * kWidth], row);
      }
      const T& by_length = map[(kMapLength + i) * kWidth];
      if (begins_at >= 0) row[ContactColumn(begins_at)] -= by_length;
      if (ends_at >= 0) row[ContactColumn(ends_at)] += by_length;
    }
    if (!parameters() || !f_.moves) return;
    for (int which = 0; which < 2; ++which) {
      const int effect = f_.moved_by[which][e];
      if (effect < 0) continue;
      const T longer = Lengthening(which, e, begins_at, ends_at);
      for (int i = 0; i < 4; ++i) {
        RowOf(side, i)[EffectColumn(effect)] +=
            longer * map[(kMapLength + i) * kWidth];
      }
    }
  }

  // `slope` is the derivative by the stiffness of element e.
  void AddStiffness(int side, int e, const T& slope, T* row) const {
    row[StiffnessColumn(side)] += f_.stiffness_ratio[e] * slope;
    if (f_.by_piece[side] < 0) return;
    for (int p = 1; p <= f_.piece[e]; ++p) {
      row[EffectColumn(f_.by_piece[side] + p - 1)] +=
          f_.stiffness[e] / f_.piece_step[f_.first(side) + p] * slope;
    }
  }

  void TapReadout(int side, int i, int begins_at, int ends_at, int e) {
    const T* at = f_.readout_map + kReadoutValues * i;
    T* tap = Tap(f_.readout_tap(i));
    const V by[4] = {Broadcast(at[1]), Broadcast(at[2]), Broadcast(at[3]),
                     Broadcast(at[4])};
    const U* from[4];
    for (int p = 0; p < 4; ++p) from[p] = Wide(RowOf(side, kTheta + p));
    for (int v = 0; v < vectors(); ++v) {
      V sum = by[0] * from[0][v];
      for (int p = 1; p < 4; ++p) sum += by[p] * from[p][v];
      Wide(tap)[v] = sum;
    }
    if (parameters()) {
      AddStiffness(side, e, at[5], tap);
    }
    if (by_contacts()) {
      if (begins_at >= 0) tap[ContactColumn(begins_at)] -= at[6] + at[7];
      if (ends_at >= 0) tap[ContactColumn(ends_at)] += at[7];
    }
    for (int which = 0; parameters() && f_.moves && which < 2; ++which) {
      const int effect = f_.moved_by[which][e];
      if (effect < 0) continue;
      T& by_effect = tap[EffectColumn(effect)];
      by_effect += Lengthening(which, e, begins_at, ends_at) * at[7];
      // The gauge stays.
      if (begins_at < 0) by_effect -= f_.start_moves[which][e] * at[6];
    }
    Log(kTap, f_.readout_tap(i));
  }

  void TapPose(int side, int first) {
    for (int i = 0; i < 3; ++i) {
      Copy(RowOf(side, i), Tap(first + i));
      Log(kTap, first + i);
    }
  }

  // N jumps to N+ = N- - f (n + mu t).
  void PassContact(int side, int c) {
    const LadderContact<T>& contact = f_.contacts[c];
    TapPose(side, f_.contact_tap(contact.index));
    if (f_.lifted) PassSurface(side, c);
    T unit[2], turned[2];
    ContactDirection(contact, f_.slot_theta[f_.elements + c], unit, turned);
    for (int i = 0; i < 2; ++i) {
      T* force = RowOf(side, kForceX + i);
      Add(-contact.normal * turned[i], RowOf(side, kTheta), force);
      if (by_contacts()) {
        force[ContactColumn(c) + 1] -= unit[i];
      }
      if (by_load()) force[affine() + 1] -= contact.d_normal * unit[i];
    }
    if (!parameters() || f_.by_friction < 0) return;
    T along[2];
    SinCos(f_.slot_theta[f_.elements + c], &along[1], &along[0]);
    for (int i = 0; i < 2; ++i) {
      RowOf(side, kForceX + i)[EffectColumn(f_.by_friction)] -=
          contact.normal * along[i];
    }
  }

  void PassRib(int rib) {
    const T ux = f_.rib_ux[rib], uy = f_.rib_uy[rib];
    const T tension = f_.state.q[6 + rib];
    T kappa = f_.rib_length[rib] * f_.rib_flexibility[rib];
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
      // T du = T / |r| (-u_y, u_x) times the motion across the rib.
      const V across = swing * (wide_x * dy - wide_y * dx);
      front_x[v] += across * wide_y;
      front_y[v] -= across * wide_x;
      back_x[v] -= across * wide_y;
      back_y[v] += across * wide_x;
    }
    if (f_.joined) {
      PassJoints(rib, length);
      kappa -= f_.joints[kJointValues * rib + kJointBowByTension];
    }
    const T strained = T(1) + tension * f_.rib_flexibility[rib];
    if (parameters()) length[RibColumn(rib)] -= strained;
    if (by_load()) length[affine() + 1] -= strained * f_.d_rib_length[rib];
    int column = 6 + rib;
    if (open_) {
      length[column] -= kappa;
    } else {
      length[affine()] += f_.closure[rib];
      column = LargestColumn(length);
      Exchange(column, kappa, rib);
    }
    RowOf(0, kForceX)[column] -= ux;
    RowOf(0, kForceY)[column] -= uy;
    RowOf(1, kForceX)[column] += ux;
    RowOf(1, kForceY)[column] += uy;
    if (f_.joined) TightenJoints(rib, column);
  }

  static int LargestColumn(const T* row) {
    int column = 0;
    T largest = Magnitude(row[0]);
    for (int j = 1; j < 6; ++j) {
      const T size = Magnitude(row[j]);
      if (size > largest) {
        largest = size;
        column = j;
      }
    }
    return column;
  }

  // Exchanges parameter `column`, in the rows of both beams, for the quantity
  // whose row is the next one of `pivots`.
  void Exchange(int column, const T& kappa, int rib) {
    for (int side = 0; side < 2; ++side) {
      ExchangeIn(column, kappa, node_[side], 4);
      ExchangeIn(column, kappa, RowOf(side, kForceX), 2);
    }
    KeepPivot(column, kappa, rib);
  }
  void ExchangeIn(int column, const T& kappa, T* rows, int count) const {
    const T* g = f_.pivots + pivots_ * stride();
    const T inverse = T(1) / g[column];
    for (int i = 0; i < count; ++i) {
      T* row = rows + i * stride();
      const T factor = row[column] * inverse;
      Add(-factor, g, row);
      row[column] = factor * kappa;
    }
  }
  void KeepPivot(int column, const T& kappa, int rib) {
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
      const U* row = Wide(RowOf(i));
      for (int v = 0; v < kParameterVectors; ++v) squares[v] += row[v] * row[v];
    }
    const T* of_column = reinterpret_cast<const T*>(squares);
    T largest = of_column[0];
    for (int j = 1; j < 6; ++j) largest = Larger(largest, of_column[j]);
    if (largest > kLargestGrowth * kLargestGrowth) Reparametrize();
  }

  void Reparametrize() {
    bool used[6] = {};
    for (int k = 0; k < 6; ++k) {
      int pivot_row = 0, column = 0;
      T largest = -1;
      for (int i = 0; i < 2 * kRows; ++i) {
        for (int j = 0; j < 6; ++j) {
          const T size = Magnitude(RowOf(i)[j]);
          // A row that was chosen is 1 in its own column and 0 elsewhere.
          if (!used[j] && size > largest) {
            largest = size;
            pivot_row = i;
            column = j;
          }
        }
      }
      if (!(largest > 0)) return;
      used[column] = true;
      Copy(RowOf(pivot_row), f_.pivots + pivots_ * stride());
      Exchange(column, T(1), -1);
    }
  }

  // At the tip positions and angles must agree; moments and forces must cancel.
  void CloseTip() {
    TapPose(0, f_.tip_tap());
    T* rows = open_ ? Tap(f_.closure_tap() + f_.ribs) : f_.tip_rows;
    for (int i = 0; i < kRows; ++i) {
      T* row = rows + i * stride();
      Copy(RowOf(0, i), row);
      Add(T(i < kMoment ? -1 : 1), RowOf(1, i), row);
      if (!open_) row[affine()] += f_.closure[f_.ribs + i];
    }
    if (parameters() && f_.moves && f_.by_back_angle >= 0) {
      rows[kTheta * stride() + EffectColumn(f_.by_back_angle)] += T(1);
    }
  }

  bool EliminateTip() {
    for (int k = 0; k < 6; ++k) {
      const T* row = f_.tip_rows + k * stride();
      const int column = LargestColumn(row);
      // Written so that a NaN fails.
      if (!(Magnitude(row[column]) > 0)) return false;
      Copy(row, f_.pivots + pivots_ * stride());
      ExchangeIn(column, T{}, f_.tip_rows + (k + 1) * stride(), 5 - k);
      KeepPivot(column, T{}, -1);
    }
    return true;
  }

  int events_ = 0, pivots_ = 0, since_check_ = 0;
  int next_contact_[2] = {0, 0};
  bool gap_taken_[2] = {false, false};
};

}  // namespace FINRAY_ISA
}  // namespace finray

#endif  // FINRAY_LADDER_LADDER_SWEEP_H_
