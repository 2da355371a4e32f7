#ifndef FINRAY_LADDER_LADDER_EVALUATE_H_
#define FINRAY_LADDER_LADDER_EVALUATE_H_

#include <cmath>

#include "finray/ladder/ladder_frame.h"
#include "finray/ladder/lanes.h"

namespace finray {
inline namespace FINRAY_ISA {

// The force of a contact with f = 1, n + mu t (n points into the finger), and
// its derivative by theta.
template <class T>
inline void ContactDirection(const LadderContact<T>& contact, const T& theta,
                             T* unit, T* turned) {
  T s, c;
  SinCos(theta, &s, &c);
  const T into = contact.side == 0 ? T(1) : T(-1);
  const T mu = contact.friction;
  unit[0] = into * s + mu * c;
  unit[1] = mu * s - into * c;
  turned[0] = into * c - mu * s;
  turned[1] = into * s + mu * c;
}

// Evaluate, the first half of a Newton step (ladder_kernel.h). Wide is the
// scheme's element over vector lanes, Single the same over one T. Starts are
// collected first and then solved vector by vector.
template <class T, class Wide, class Single>
class LadderEvaluator {
 public:
  using V = typename Lanes<T>::Vector;
  using U = typename Lanes<T>::Unaligned;
  static constexpr int kWidth = Lanes<T>::kWidth;

  LadderEvaluator(LadderFrame<T>* frame, SweepColumns columns)
      : f_(*frame), columns_(columns) {}

  void Evaluate(bool propagate) {
    AssignReadouts();
    FillSlots(propagate);
    for (int slot = 0; slot < f_.slots(); slot += kWidth) ComputeMaps(slot);
    CollectGaps();
  }

 private:
  struct End {
    T x, y, theta, moment;
  };

  int LastSlot(int element) const {
    int slot = element;
    for (int c = 0; c < f_.contact_count; ++c) {
      if (f_.contacts[c].element == element) slot = f_.elements + c;
    }
    return slot;
  }

  // Walks both beams together, rung by rung, and puts start and internal force
  // of every element and contact into the slots.
  void FillSlots(bool propagate) {
    const LadderNodes<T>& z = f_.state;
    T force[2][2] = {{z.q[1], z.q[2]}, {z.q[4], z.q[5]}};
    int at[2] = {0, f_.front_elements};
    int contact[2] = {0, 0};
    while (contact[1] < f_.contact_count && f_.contacts[contact[1]].side == 0) {
      ++contact[1];
    }
    for (int rib = 0; rib <= f_.ribs; ++rib) {
      for (int side = 0; side < 2; ++side) {
        const int end =
            rib < f_.ribs ? f_.rib_element[side][rib] : f_.end(side);
        for (; at[side] < end; ++at[side]) {
          FillElement(at[side], force[side], &contact[side],
                      propagate && at[side] + 1 < f_.end(side));
        }
      }
      if (rib < f_.ribs) PassRib(rib, at, force, propagate);
    }
    const int first = f_.ribs;
    for (int i = 0; i < 2; ++i) {
      f_.closure[first + 4 + i] = force[0][i] + force[1][i];
    }
    // The slots that fill up the last vector must not divide by zero.
    for (int slot = f_.slots(); slot % kWidth != 0; ++slot) {
      PutSlot(slot, {T{}, T{}, T{}, T{}}, 0, T{});
      f_.slot_fx[slot] = f_.slot_fy[slot] = T{};
      f_.slot_stiffness[slot] = T(1);
      f_.slot_axial[slot] = T{};
    }
  }

  void PutSlot(int slot, const End& start, int element, const T& length) {
    f_.slot_x[slot] = start.x;
    f_.slot_y[slot] = start.y;
    f_.slot_theta[slot] = start.theta;
    f_.slot_moment[slot] = start.moment;
    f_.slot_length[slot] = length;
    f_.slot_stiffness[slot] = f_.stiffness[element];
    f_.slot_axial[slot] = f_.axial_flexibility[element];
  }

  void FillElement(int e, T* force, int* contact, bool propagate) {
    const LadderNodes<T>& z = f_.state;
    PutSlot(e, {z.x[e], z.y[e], z.theta[e], z.moment[e]}, e, f_.length[e]);
    f_.slot_fx[e] = force[0];
    f_.slot_fy[e] = force[1];
    int slot = e;
    T from{};
    for (; *contact < f_.contact_count && f_.contacts[*contact].element == e;
         ++*contact) {
      const LadderContact<T>& c = f_.contacts[*contact];
      f_.slot_length[slot] = c.offset - from;
      End end = SolveSlot(slot);
      T unit[2], turned[2];
      ContactDirection(c, end.theta, unit, turned);
      if (f_.lifted) end.moment += c.normal * (c.lift * c.friction);
      force[0] -= c.normal * unit[0];
      force[1] -= c.normal * unit[1];
      slot = f_.elements + *contact;
      from = c.offset;
      PutSlot(slot, end, e, f_.length[e] - from);
      f_.slot_fx[slot] = force[0];
      f_.slot_fy[slot] = force[1];
    }
    if (propagate) {
      const End end = SolveSlot(slot);
      z.x[e + 1] = end.x;
      z.y[e + 1] = end.y;
      z.theta[e + 1] = end.theta;
      z.moment[e + 1] = end.moment;
    }
  }

  End SolveSlot(int slot) {
    Single element;
    element.Solve({f_.slot_theta[slot], f_.slot_moment[slot], f_.slot_fx[slot],
                   f_.slot_fy[slot]},
                  f_.slot_stiffness[slot], f_.slot_axial[slot],
                  f_.slot_length[slot]);
    const auto& end = element.map().end;
    return {f_.slot_x[slot] + end[0], f_.slot_y[slot] + end[1], end[2], end[3]};
  }

  void PassRib(int rib, const int at[2], T force[2][2], bool propagate) {
    const LadderNodes<T>& z = f_.state;
    const T dx = z.x[at[1]] - z.x[at[0]], dy = z.y[at[1]] - z.y[at[0]];
    const T distance = std::sqrt(dx * dx + dy * dy);
    const T ux = dx / distance, uy = dy / distance;
    const T tension = z.q[6 + rib];
    f_.rib_ux[rib] = ux;
    f_.rib_uy[rib] = uy;
    f_.rib_distance[rib] = distance;
    f_.closure[rib] = distance - f_.rib_length[rib] *
                                     (T(1) + tension * f_.rib_flexibility[rib]);
    force[0][0] -= tension * ux;
    force[0][1] -= tension * uy;
    force[1][0] += tension * ux;
    force[1][1] += tension * uy;
    if (f_.joined) PassJoints(rib, at, force, propagate);
  }

  // The beams turn the rib by the moments m of rib_law.h, and the rib turns the
  // beams back: M jumps to M+ = M- + m. The couple Q d of the transverse forces
  // balances the rib, Q = (m_F + m_B) / d with d the distance of the hinges.
  void PassJoints(int rib, const int at[2], T force[2][2], bool propagate) {
    const LadderNodes<T>& z = f_.state;
    const T ux = f_.rib_ux[rib], uy = f_.rib_uy[rib];
    const T swing = std::atan2(f_.rest_ux[rib] * uy - f_.rest_uy[rib] * ux,
                               f_.rest_ux[rib] * ux + f_.rest_uy[rib] * uy);
    T* joint = f_.joints + kJointValues * rib;
    for (int side = 0; side < 2; ++side) {
      joint[kJointTurn + side] =
          z.theta[at[side]] - f_.base_angle[side] - swing;
    }
    f_.react(
        f_, rib,
        columns_ != SweepColumns::kNone && columns_ != SweepColumns::kContacts);
    f_.closure[rib] += joint[kJointBow];
    T sum{};
    for (int side = 0; side < 2; ++side) {
      const T& moment = joint[kJointMoment + side];
      if (propagate) z.moment[at[side]] += moment;
      sum += moment;
    }
    const T across = sum / f_.rib_distance[rib];
    force[0][0] -= across * uy;
    force[0][1] += across * ux;
    force[1][0] += across * uy;
    force[1][1] -= across * ux;
  }

  static V Load(const T* from) { return *reinterpret_cast<const U*>(from); }
  static void Store(T* to, const V& value) {
    *reinterpret_cast<U*>(to) = value;
  }
  static T* Lane(V* value) { return reinterpret_cast<T*>(value); }

  void ComputeMaps(int slot) {
    Wide element;
    element.SolveAndDifferentiate(
        {Load(f_.slot_theta + slot), Load(f_.slot_moment + slot),
         Load(f_.slot_fx + slot), Load(f_.slot_fy + slot)},
        Load(f_.slot_stiffness + slot), Load(f_.slot_axial + slot),
        Load(f_.slot_length + slot));
    const auto& map = element.map();
    T* out = f_.maps + slot * kMapValues;
    for (int i = 0; i < 4; ++i) {
      Store(out + (kMapEnd + i) * kWidth, map.end[i]);
      for (int p = 0; p < 4; ++p) {
        Store(out + (kMapStart + 4 * i + p) * kWidth, map.d_start[i][p]);
      }
    }
    Store(f_.truncation + slot, element.Truncation());
    if (columns_ == SweepColumns::kParameters) {
      element.DifferentiateByStiffness();
      for (int i = 0; i < 4; ++i) {
        Store(out + (kMapStiffness + i) * kWidth, map.d_stiffness[i]);
      }
    }
    int readouts = 0;
    bool at_contact = false;
    for (int lane = 0; lane < kWidth; ++lane) {
      const int here = Readouts(slot + lane);
      if (here > readouts) readouts = here;
      at_contact |= IsAtContact(slot + lane);
    }
    const bool parameters = columns_ == SweepColumns::kParameters;
    if ((at_contact && (columns_ == SweepColumns::kContacts || parameters)) ||
        (f_.moves && parameters)) {
      element.DifferentiateByLength();
      for (int i = 0; i < 4; ++i) {
        Store(out + (kMapLength + i) * kWidth, map.d_length[i]);
      }
    }
    for (int k = 0; k < readouts; ++k) ReadGauges(element, slot, k);
  }

  // Whether the slot's length changes when a contact moves.
  bool IsAtContact(int slot) const {
    if (slot >= f_.elements) return true;
    for (int c = 0; c < f_.contact_count; ++c) {
      if (f_.contacts[c].element == slot) return true;
    }
    return false;
  }

  // The k-th readout of each of the slots.
  void ReadGauges(const Wide& element, int slot, int k) {
    V offset{};
    for (int lane = 0; lane < kWidth; ++lane) {
      if (k < Readouts(slot + lane)) {
        Lane(&offset)[lane] = ReadoutOffset(slot + lane, k);
      }
    }
    auto at = element.AngleAt(offset);
    for (int lane = 0; lane < kWidth; ++lane) {
      if (k >= Readouts(slot + lane)) continue;
      T* out =
          f_.readout_map + kReadoutValues * (f_.first_readout[slot + lane] + k);
      out[0] = Lane(&at.theta_rad)[lane];
      for (int p = 0; p < 4; ++p) out[1 + p] = Lane(at.d_start + p)[lane];
      out[5] = Lane(&at.d_stiffness)[lane];
      out[6] = Lane(&at.d_offset)[lane];
      out[7] = Lane(&at.d_length)[lane];
    }
  }

  T MapEnd(int slot, int i) const {
    return f_.maps[(slot / kWidth) * kWidth * kMapValues +
                   (kMapEnd + i) * kWidth + slot % kWidth];
  }
  End SlotEnd(int slot) const {
    return {f_.slot_x[slot] + MapEnd(slot, 0),
            f_.slot_y[slot] + MapEnd(slot, 1), MapEnd(slot, 2),
            MapEnd(slot, 3)};
  }

  void CollectGaps() {
    const LadderNodes<T>& z = f_.state;
    End tip[2];
    T largest{};
    for (int side = 0; side < 2; ++side) {
      for (int e = f_.first(side); e < f_.end(side); ++e) {
        const End end = SlotEnd(f_.contact_count == 0 ? e : LastSlot(e));
        if (e + 1 == f_.end(side)) {
          tip[side] = end;
          break;
        }
        T* gap = f_.gap + 4 * (e + 1);
        gap[0] = end.x - z.x[e + 1];
        gap[1] = end.y - z.y[e + 1];
        gap[2] = end.theta - z.theta[e + 1];
        gap[3] = end.moment - z.moment[e + 1];
        if (f_.joined) continue;
        for (int i = 0; i < 4; ++i) {
          largest = Larger(largest, Magnitude(gap[i]));
        }
      }
    }
    if (f_.joined) largest = AddJointsToGaps();
    f_.tip[0] = tip[0].x;
    f_.tip[1] = tip[0].y;
    f_.tip[2] = tip[0].theta;
    T* closure = f_.closure + f_.ribs;
    closure[0] = tip[0].x - tip[1].x;
    closure[1] = tip[0].y - tip[1].y;
    closure[2] =
        (tip[0].theta - f_.base_angle[0]) - (tip[1].theta - f_.base_angle[1]);
    closure[3] = tip[0].moment + tip[1].moment;
    for (int i = 0; i < f_.ribs + 6; ++i) {
      largest = Larger(largest, Magnitude(f_.closure[i]));
    }
    f_.residual = largest;
  }

  // Returns the largest gap.
  T AddJointsToGaps() {
    for (int side = 0; side < 2; ++side) {
      for (int rib = 0; rib < f_.ribs; ++rib) {
        f_.gap[4 * f_.rib_element[side][rib] + 3] +=
            f_.joints[kJointValues * rib + kJointMoment + side];
      }
    }
    T largest{};
    for (int side = 0; side < 2; ++side) {
      for (int i = 4 * (f_.first(side) + 1); i < 4 * f_.end(side); ++i) {
        largest = Larger(largest, Magnitude(f_.gap[i]));
      }
    }
    return largest;
  }

  // Finds the slot that holds each readout: behind the last contact at or
  // before it.
  void AssignReadouts() {
    const int slots = (f_.slots() + kWidth - 1) / kWidth * kWidth;
    for (int slot = 0; slot < slots; ++slot) {
      f_.first_readout[slot] = f_.end_readout[slot] = 0;
    }
    for (int i = 0; i < f_.readout_count; ++i) {
      const LadderReadout<T>& readout = f_.readouts[i];
      int slot = readout.element;
      for (int c = 0; c < f_.contact_count; ++c) {
        if (f_.contacts[c].element == readout.element &&
            readout.offset - f_.contacts[c].offset >= 0) {
          slot = f_.elements + c;
        }
      }
      if (f_.end_readout[slot] == 0) f_.first_readout[slot] = i;
      f_.end_readout[slot] = i + 1;
    }
  }
  int Readouts(int slot) const {
    return f_.end_readout[slot] - f_.first_readout[slot];
  }
  T ReadoutOffset(int slot, int k) const {
    const T& offset = f_.readouts[f_.first_readout[slot] + k].offset;
    if (slot < f_.elements) return offset;
    return offset - f_.contacts[slot - f_.elements].offset;
  }

  LadderFrame<T>& f_;
  const SweepColumns columns_;
};

}  // namespace FINRAY_ISA
}  // namespace finray

#endif  // FINRAY_LADDER_LADDER_EVALUATE_H_
