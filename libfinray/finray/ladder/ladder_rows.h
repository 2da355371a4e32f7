#ifndef FINRAY_LADDER_LADDER_ROWS_H_
#define FINRAY_LADDER_LADDER_ROWS_H_

#include "finray/ladder/ladder_walk_back.h"

namespace finray {
inline namespace FINRAY_ISA {

// The rows of both beams during a sweep (ladder_kernel.h): where they are, what
// their columns mean, and what joints, clamps, surfaces and moved nodes do to
// them. `open` is for all
// of q as parameters.
template <class T, int kVectors>
class LadderRows : protected LadderWalkBack<T, kVectors> {
 protected:
  using Base = LadderWalkBack<T, kVectors>;
  using Base::Broadcast, Base::columns_, Base::f_, Base::Node, Base::stride,
      Base::Add, Base::by_load, Base::Tap, Base::vectors, Base::Wide;
  using typename Base::V;

  LadderRows(LadderFrame<T>* frame, SweepColumns columns, bool open)
      : Base(frame, columns), open_(open) {}

  enum Row { kX, kY, kTheta, kMoment, kForceX, kForceY, kRows };

  int affine() const { return open_ ? f_.affine : 6; }
  // The rows of a node's position, angle and moment are computed where they are
  // kept. Behind the nodes come the tip and a contact of each side.
  T* TipNode(int side) const { return Node(f_.elements + side); }
  T* ContactNode(int side) const { return Node(f_.elements + 2 + side); }
  T* RowOf(int side, int row) const {
    return row < kForceX ? node_[side] + row * stride()
                         : f_.rows + (2 * side + row - kForceX) * stride();
  }
  T* RowOf(int i) const { return RowOf(i / kRows, i % kRows); }

  bool parameters() const { return columns_ == SweepColumns::kParameters; }
  bool by_contacts() const {
    return parameters() || columns_ == SweepColumns::kContacts;
  }
  int ContactColumn(int c) const {
    return affine() + 1 + 2 * f_.contacts[c].index;
  }
  int StiffnessColumn(int side) const {
    return affine() + 1 + 2 * f_.contact_count + side;
  }
  int RibColumn(int rib) const {
    return affine() + 1 + 2 * f_.contact_count + 2 + rib;
  }
  int EffectColumn(int effect) const { return RibColumn(f_.ribs) + effect; }

  const T* Joint(int rib) const { return f_.joints + kJointValues * rib; }

  // With the rib's turn dphi = across / d, where u and v are its directions
  // along and across, da = dtheta - dphi and
  //
  //   dm = H da + m_T dT,   dbow = m_T . da + bow_T dT,
  //   dQ = (dm_F + dm_B - Q du) / d,   d(Q v) = dQ v - Q dphi u.
  //
  // The terms of dT are left to TightenJoints. `length` is the row of the rib's
  // closure equation.
  void PassJoints(int rib, T* length) {
    const T* joint = Joint(rib);
    const T ux = f_.rib_ux[rib], uy = f_.rib_uy[rib];
    const T inverse = T(1) / f_.rib_distance[rib];
    const T transverse =
        (joint[kJointMoment] + joint[kJointMoment + 1]) * inverse;
    const V wide_x = Broadcast(ux), wide_y = Broadcast(uy);
    const V of_front = Broadcast(joint[kJointStiffness]),
            of_both = Broadcast(joint[kJointStiffness + 1]),
            of_back = Broadcast(joint[kJointStiffness + 2]);
    const V bow_front = Broadcast(joint[kJointByTension]),
            bow_back = Broadcast(joint[kJointByTension + 1]);
    const V wide_inverse = Broadcast(inverse);
    const V wide_transverse = Broadcast(transverse);
    for (int v = 0; v < vectors(); ++v) {
      const V dx = Wide(RowOf(1, kX))[v] - Wide(RowOf(0, kX))[v];
      const V dy = Wide(RowOf(1, kY))[v] - Wide(RowOf(0, kY))[v];
      const V turn = wide_inverse * (wide_x * dy - wide_y * dx);
      const V front = Wide(RowOf(0, kTheta))[v] - turn;
      const V back = Wide(RowOf(1, kTheta))[v] - turn;
      const V front_moment = of_front * front + of_both * back;
      const V back_moment = of_both * front + of_back * back;
      const V across =
          wide_inverse * (front_moment + back_moment -
                          wide_transverse * (wide_x * dx + wide_y * dy));
      Wide(RowOf(0, kMoment))[v] += front_moment;
      Wide(RowOf(1, kMoment))[v] += back_moment;
      Wide(length)[v] += bow_front * front + bow_back * back;
      AddAcross(v, across, wide_transverse * turn, wide_x, wide_y);
    }
    if (by_load()) {
      AddJoint(rib, affine() + 1, length, joint + kJointBy + 3 * kByLength,
               f_.d_rib_length[rib]);
    }
    if (!parameters()) return;
    AddJoint(rib, RibColumn(rib), length, joint + kJointBy + 3 * kByLength,
             T(1));
    if (f_.moves) TurnRest(rib, length);
    if (f_.by_hinge_stiffness >= 0) {
      AddJoint(rib, EffectColumn(f_.by_hinge_stiffness), length,
               joint + kJointBy + 3 * kByHinge, T(1));
    }
    if (f_.by_rib_bending >= 0) {
      AddJoint(rib, EffectColumn(f_.by_rib_bending), length,
               joint + kJointBy + 3 * kByBending, f_.bending_ratio[rib]);
    }
  }
  // Adds to a column the change `factor` of what (m_F, m_B, bow) have the
  // derivatives `by` by.
  void AddJoint(int rib, int column, T* length, const T* by,
                const T& factor) const {
    const T moments[2] = {by[0] * factor, by[1] * factor};
    length[column] += by[2] * factor;
    AddMoments(rib, column, moments);
  }
  void AddMoments(int rib, int column, const T moments[2]) const {
    for (int side = 0; side < 2; ++side) {
      RowOf(side, kMoment)[column] += moments[side];
    }
    const T across = (moments[0] + moments[1]) / f_.rib_distance[rib];
    const T x = across * f_.rib_uy[rib], y = across * f_.rib_ux[rib];
    RowOf(0, kForceX)[column] -= x;
    RowOf(0, kForceY)[column] += y;
    RowOf(1, kForceX)[column] += x;
    RowOf(1, kForceY)[column] -= y;
  }
  // The moments that the tension in `column` adds.
  void TightenJoints(int rib, int column) const {
    AddMoments(rib, column, Joint(rib) + kJointByTension);
  }
  // The rest of the rib's ends turns with the places of the hinges and with the
  // back angle.
  void TurnRest(int rib, T* length) const {
    for (int side = 0; side < 2; ++side) {
      const int effect = f_.hinge_effect[side][rib];
      const T& turn = f_.rest_turn[side][rib];
      if (effect >= 0) TurnEnds(rib, length, effect, turn, turn);
    }
    if (f_.by_back_angle < 0) return;
    const T& turn = f_.rest_turn[2][rib];
    TurnEnds(rib, length, f_.by_back_angle, turn, turn - T(1));
  }
  // Adds to the column of an effect that turns both ends.
  void TurnEnds(int rib, T* length, int effect, const T& front,
                const T& back) const {
    const T* joint = Joint(rib);
    const T* h = joint + kJointStiffness;
    const T by[3] = {
        h[0] * front + h[1] * back, h[1] * front + h[2] * back,
        joint[kJointByTension] * front + joint[kJointByTension + 1] * back};
    AddJoint(rib, EffectColumn(effect), length, by, T(1));
  }
  // N_front += across v - along u, N_back the opposite.
  void AddAcross(int v, const V& across, const V& along, const V& ux,
                 const V& uy) {
    const V x = across * uy + along * ux, y = across * ux - along * uy;
    Wide(RowOf(0, kForceX))[v] -= x;
    Wide(RowOf(0, kForceY))[v] += y;
    Wide(RowOf(1, kForceX))[v] += x;
    Wide(RowOf(1, kForceY))[v] -= y;
  }

  // What clamps and the back angle do to the bases.
  void TurnBases() {
    if (parameters() && f_.moves && f_.by_back_angle >= 0) {
      const int column = EffectColumn(f_.by_back_angle);
      RowOf(1, kX)[column] += f_.base_x_by_angle;
      RowOf(1, kTheta)[column] += T(1);
    }
    if (!f_.clamps) return;
    for (int side = 0; side < 2; ++side) {
      T* turn = RowOf(side, kTheta);
      turn[3 * side] += f_.clamp[side];
      if (parameters() && f_.by_clamp[side] >= 0) {
        turn[EffectColumn(f_.by_clamp[side])] += f_.state.q[3 * side];
      }
    }
  }

  // How much longer a slot of element e becomes with an effect that moves its
  // bay. Contacts stay.
  T Lengthening(int which, int e, int begins_at, int ends_at) const {
    T longer{};
    if (ends_at < 0) longer += f_.end_moves[which][e];
    if (begins_at < 0) longer -= f_.start_moves[which][e];
    return longer;
  }

  // The pose of a contact is that of the surface, r + h (-sin, cos)(theta), and
  // friction makes M jump to M+ = M- + h mu f. Here h counts to the left.
  void PassSurface(int side, int c) {
    const LadderContact<T>& contact = f_.contacts[c];
    T along[2];
    SinCos(f_.slot_theta[f_.elements + c], &along[1], &along[0]);
    T* pose[2] = {Tap(f_.contact_tap(contact.index)),
                  Tap(f_.contact_tap(contact.index) + 1)};
    T* moment = RowOf(side, kMoment);
    for (int i = 0; i < 2; ++i) {
      Add(-contact.lift * along[i], RowOf(side, kTheta), pose[i]);
    }
    const T lever = contact.lift * contact.friction;
    if (by_contacts()) moment[ContactColumn(c) + 1] += lever;
    if (by_load()) moment[affine() + 1] += contact.d_normal * lever;
    if (!parameters()) return;
    if (f_.by_friction >= 0) {
      moment[EffectColumn(f_.by_friction)] += contact.normal * contact.lift;
    }
    if (f_.by_surface < 0 || side != 0 || contact.is_mark) return;
    const int column = EffectColumn(f_.by_surface);
    pose[0][column] -= along[1];
    pose[1][column] += along[0];
    moment[column] += contact.normal * contact.friction;
  }

  const bool open_;
  T* node_[2] = {};  // the present rows of each beam
};

}  // namespace FINRAY_ISA
}  // namespace finray

#endif  // FINRAY_LADDER_LADDER_ROWS_H_
