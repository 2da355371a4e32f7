#ifndef FINRAY_STATICS_LADDER_EVALUATE_H_
#define FINRAY_STATICS_LADDER_EVALUATE_H_

#include "finray/statics/ladder_frame.h"
#include "finray/statics/lanes.h"

namespace finray {
inline namespace FINRAY_ISA {

template <class T>
inline T Magnitude(T a) {
  return a < 0 ? -a : a;
}

// The force of a contact for f = 1, normal into the finger plus friction along
// the tangent, n + mu t, and its derivative by theta.
template <class T>
inline void ContactDirection(const LadderContact<T>& contact, T theta, T* unit,
                             T* turned) {
  T s, c;
  SinCos(theta, &s, &c);
  const T into = contact.side == 0 ? T(1) : T(-1), mu = contact.friction;
  unit[0] = into * s + mu * c;
  unit[1] = -into * c + mu * s;
  turned[0] = into * c - mu * s;
  turned[1] = into * s + mu * c;
}

// The first half of a Newton step (ladder_kernel.h). Wide is the scheme's
// element over vector lanes, Single the same over one number.
template <class T, class Wide, class Single>
class LadderEvaluator {
 public:
  using V = typename Lanes<T>::Vector;
  using U = typename Lanes<T>::Unaligned;
  static constexpr int kWidth = Lanes<T>::kWidth;

  explicit LadderEvaluator(LadderFrame<T>* frame) : f_(*frame) {}

  T Evaluate(bool parameters, bool propagate) {
    FillSlots(propagate);
    for (int slot = 0; slot < f_.slots(); slot += kWidth) {
      ComputeMaps(slot, parameters);
    }
    return CollectGaps();
  }

  void ReadGauges() {
    AssignReadouts();
    Wide element;
    for (int first = 0; first < f_.readout_count; first += kWidth) {
      const int lanes = f_.readout_count - first;
      T gathered[8][kWidth];
      for (int lane = 0; lane < kWidth; ++lane) {
        const int i = first + (lane < lanes ? lane : 0);
        const int slot = f_.readout_slot[i];
        const T offset = ReadoutOffset(i);
        const T values[8] = {f_.slot_theta[slot],     f_.slot_moment[slot],
                             f_.slot_fx[slot],        f_.slot_fy[slot],
                             f_.slot_stiffness[slot], f_.slot_axial[slot],
                             f_.slot_length[slot],    offset};
        for (int k = 0; k < 8; ++k) gathered[k][lane] = values[k];
      }
      V input[8];
      for (int k = 0; k < 8; ++k) input[k] = Load(gathered[k]);
      element.SolveAndDifferentiate({input[0], input[1], input[2], input[3]},
                                    input[4], input[5], input[6]);
      element.DifferentiateByParameters();
      const auto at = element.AngleAt(input[7]);
      for (int lane = 0; lane < kWidth && lane < lanes; ++lane) {
        T* out = f_.readout_map + kReadoutValues * (first + lane);
        out[0] = at.theta_rad[lane];
        for (int p = 0; p < 4; ++p) out[1 + p] = at.d_start[p][lane];
        out[5] = at.d_stiffness[lane];
        out[6] = at.d_offset[lane];
        out[7] = at.d_length[lane];
      }
    }
  }

 private:
  struct End {
    T x, y, theta, moment;
  };

  int SideEnd(int side) const {
    return side == 0 ? f_.front_elements : f_.elements;
  }
  int LastSlot(int element) const {
    int slot = element;
    for (int c = 0; c < f_.contact_count; ++c) {
      if (f_.contacts[c].element == element) slot = f_.elements + c;
    }
    return slot;
  }

  // Forces by walking both beams together, rung by rung; contacts on the way.
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
            rib < f_.ribs ? f_.rib_element[side][rib] : SideEnd(side);
        for (; at[side] < end; ++at[side]) {
          FillElement(at[side], force[side], &contact[side],
                      propagate && at[side] + 1 < SideEnd(side));
        }
      }
      if (rib < f_.ribs) PassRib(rib, at, force);
    }
    const int first = f_.ribs;
    for (int i = 0; i < 2; ++i) {
      f_.closure[first + 4 + i] = force[0][i] + force[1][i];
    }
    // What fills the last lanes must be harmless.
    for (int slot = f_.slots(); slot % kWidth != 0; ++slot) {
      PutSlot(slot, {0, 0, 0, 0}, 0, 0);
      f_.slot_fx[slot] = f_.slot_fy[slot] = 0;
      f_.slot_stiffness[slot] = 1;
      f_.slot_axial[slot] = 0;
    }
  }

  void PutSlot(int slot, const End& start, int element, T length) {
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
    T from = 0;
    for (; *contact < f_.contact_count && f_.contacts[*contact].element == e;
         ++*contact) {
      const LadderContact<T>& c = f_.contacts[*contact];
      f_.slot_length[slot] = c.offset - from;
      const End end = SolveSlot(slot);
      T unit[2], turned[2];
      ContactDirection(c, end.theta, unit, turned);
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

  End SolveSlot(int slot) const {
    Single element;
    element.Solve({f_.slot_theta[slot], f_.slot_moment[slot], f_.slot_fx[slot],
                   f_.slot_fy[slot]},
                  f_.slot_stiffness[slot], f_.slot_axial[slot],
                  f_.slot_length[slot]);
    const auto& end = element.map().end;
    return {f_.slot_x[slot] + end[0], f_.slot_y[slot] + end[1], end[2], end[3]};
  }

  void PassRib(int rib, const int at[2], T force[2][2]) {
    const LadderNodes<T>& z = f_.state;
    const T dx = z.x[at[1]] - z.x[at[0]], dy = z.y[at[1]] - z.y[at[0]];
    const T distance = std::sqrt(dx * dx + dy * dy);
    const T ux = dx / distance, uy = dy / distance;
    const T tension = z.q[6 + rib];
    f_.rib_ux[rib] = ux;
    f_.rib_uy[rib] = uy;
    f_.rib_distance[rib] = distance;
    f_.closure[rib] =
        distance - f_.rib_length[rib] * (1 + tension * f_.rib_flexibility[rib]);
    force[0][0] -= tension * ux;
    force[0][1] -= tension * uy;
    force[1][0] += tension * ux;
    force[1][1] += tension * uy;
  }

  static V Load(const T* from) { return *reinterpret_cast<const U*>(from); }
  static void Store(T* to, const V& value) {
    *reinterpret_cast<U*>(to) = value;
  }

  void ComputeMaps(int slot, bool parameters) {
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
    if (!parameters) return;
    element.DifferentiateByParameters();
    for (int i = 0; i < 4; ++i) {
      Store(out + (kMapStiffness + i) * kWidth, map.d_stiffness[i]);
      Store(out + (kMapLength + i) * kWidth, map.d_length[i]);
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

  T CollectGaps() {
    const LadderNodes<T>& z = f_.state;
    End tip[2];
    T largest = 0;
    // Written so that a NaN gets through.
    const auto meet = [&largest](T residual) {
      const T size = Magnitude(residual);
      if (!(size <= largest)) largest = size;
    };
    for (int side = 0; side < 2; ++side) {
      for (int e = side == 0 ? 0 : f_.front_elements; e < SideEnd(side); ++e) {
        const End end = SlotEnd(f_.contact_count == 0 ? e : LastSlot(e));
        if (e + 1 == SideEnd(side)) {
          tip[side] = end;
          break;
        }
        T* gap = f_.gap + 4 * (e + 1);
        gap[0] = end.x - z.x[e + 1];
        gap[1] = end.y - z.y[e + 1];
        gap[2] = end.theta - z.theta[e + 1];
        gap[3] = end.moment - z.moment[e + 1];
        for (int i = 0; i < 4; ++i) meet(gap[i]);
      }
    }
    f_.tip[0] = tip[0].x;
    f_.tip[1] = tip[0].y;
    f_.tip[2] = tip[0].theta;
    T* closure = f_.closure + f_.ribs;
    closure[0] = tip[0].x - tip[1].x;
    closure[1] = tip[0].y - tip[1].y;
    closure[2] =
        (tip[0].theta - f_.base_angle[0]) - (tip[1].theta - f_.base_angle[1]);
    closure[3] = tip[0].moment + tip[1].moment;
    for (int i = 0; i < f_.ribs + 6; ++i) meet(f_.closure[i]);
    return largest;
  }

  // The slot that holds each readout: past the last contact at or before it.
  void AssignReadouts() {
    for (int i = 0; i < f_.readout_count; ++i) {
      const LadderReadout<T>& readout = f_.readouts[i];
      int slot = readout.element;
      for (int c = 0; c < f_.contact_count; ++c) {
        if (f_.contacts[c].element == readout.element &&
            f_.contacts[c].offset <= readout.offset) {
          slot = f_.elements + c;
        }
      }
      f_.readout_slot[i] = slot;
    }
  }
  T ReadoutOffset(int i) const {
    const int slot = f_.readout_slot[i];
    const T from =
        slot < f_.elements ? T(0) : f_.contacts[slot - f_.elements].offset;
    return f_.readouts[i].offset - from;
  }

  LadderFrame<T>& f_;
};

}  // namespace FINRAY_ISA
}  // namespace finray

#endif  // FINRAY_STATICS_LADDER_EVALUATE_H_
