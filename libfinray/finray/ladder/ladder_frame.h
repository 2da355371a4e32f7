#ifndef FINRAY_LADDER_LADDER_FRAME_H_
#define FINRAY_LADDER_LADDER_FRAME_H_

namespace finray {

// The data of the ladder kernel (ladder_kernel.h) in plain arrays. The kernel
// is compiled for several instruction sets, so it must not share inline
// functions of a library with other code. Lengths are in l_0, moments in EI_0 /
// l_0 and forces in EI_0 / l_0^2, with EI_0 = sqrt(EI_front EI_back); so all
// numbers are comparable when pivots are chosen.
//
// Elements are numbered front beam first, base to tip, then the back beam. A
// slot is a piece of an element: the piece before the first contact has the
// element's number, the piece behind contact c has number elements + c.
//
// T is double or float; vector lanes are elements (in Evaluate) or columns (in
// Sweep).

/// The derivatives that a sweep carries beside the Newton step.
enum class SweepColumns {
  kNone,
  kContacts,    ///< By l_c, f_c of each contact.
  kParameters,  ///< By l_c, f_c of each contact; EI front, back; rib lengths;
                ///< and the effects that the frame carries.
  kLoad,        ///< By the load factor of contact forces and prestress.
};

/// A contact at its place in the mesh.
template <class T>
struct LadderContact {
  int side;  ///< 0 front, 1 back.
  int element;
  int index;     ///< The caller's number of the contact.
  bool is_mark;  ///< It lies on the beam, not on its surface.
  T offset;      ///< From the start of the element.
  T normal;
  T friction;
  T d_normal;  ///< Derivative of `normal` by the load factor.
  T lift;      ///< Only with lifted: of a mark 0, else that of the beam.
};

/// One end of a gauge. The gauge's angle is the sum of sign * theta over both.
template <class T>
struct LadderReadout {
  int gauge;
  int sign;
  int element;
  T offset;
};

/// Base moments and forces and rib tensions (q of ladder.h), and (x, y, theta,
/// M) at the start of each element.
template <class T>
struct LadderNodes {
  T *q, *x, *y, *theta, *moment;
};

/// The offsets of the members of BasicElementMap in LadderFrame::maps, lanes
/// innermost.
constexpr int kMapEnd = 0, kMapStart = 4, kMapStiffness = 20, kMapLength = 24,
              kMapValues = 28;
/// A readout has the angle, its derivatives by the start (4), EI, offset and
/// length.
constexpr int kReadoutValues = 8;
/// The offsets in LadderFrame::joints: the turns of a rib's ends and its
/// reaction (rib_law.h), with derivatives of (m_F, m_B, bow) by L, EI and k.
constexpr int kJointTurn = 0, kJointStiffness = 2, kJointMoment = 5,
              kJointByTension = 7, kJointBow = 9, kJointBowByTension = 10,
              kJointBy = 11, kJointValues = 20;
enum JointBy { kByLength, kByBending, kByHinge };
/// The columns of a node's rows that are used: six parameters, the step, and
/// derivatives by the load or by up to kFittedContacts contacts.
constexpr int kNodeColumns = 8, kMostNodeColumns = 16;
constexpr int kFittedContacts = 2;
/// The growth of a sweep's columns is checked after this many elements, each of
/// which multiplies them by a small number.
constexpr int kGrowthCheckEvery = 4;

template <class T>
struct LadderFrame {
  // The finger and its mesh.
  int front_elements = 0, elements = 0, ribs = 0;
  T base_x[2] = {}, base_angle[2] = {};
  T *length, *stiffness, *stiffness_ratio, *axial_flexibility;
  int *rib_element[2];  ///< The element that starts at the hinge.
  /// Only with by_piece: the piece of each element, from 0, and for each piece,
  /// counted from the first element of its beam, its EI over that before it.
  int *piece;
  T *piece_step;
  T *rib_length, *rib_flexibility, *d_rib_length;
  /// Ribs whose ends carry moments (rib_law.h): on hinge springs, k, or bent,
  /// EI (0: rigid), that over EI of the first such rib, and lengths of their
  /// rigid ends; and the rib's direction in the undeformed finger.
  bool joined = false;
  T *hinge_stiffness[2], *rib_bending, *bending_ratio, *rib_end[2], *rest_ux,
      *rest_uy;
  /// ReactInFrame of rib_law.h, which is compiled once.
  using React = void(LadderFrame &frame, int rib, bool derivatives);
  React *react = nullptr;
  /// Clamps that turn: their compliance.
  bool clamps = false;
  T clamp[2] = {};
  /// Surfaces beside the beams: their height to the left of the beam, that is
  /// outwards in front and inwards behind.
  bool lifted = false;
  T lift[2] = {};
  /// Only if nodes move with effects: the effects, or -1, that move the start
  /// [0] and the end [1] of an element's bay, and the motion of the element's
  /// start and end with them.
  bool moves = false;
  int *moved_by[2];
  T *start_moves[2], *end_moves[2];
  /// The effects, or -1, that move a rib's hinges; the turn of the rib in the
  /// undeformed finger with them and with the back angle; and the motion of
  /// the back beam's base with the back angle.
  int *hinge_effect[2];
  T *rest_turn[3];
  T base_x_by_angle = {};
  int readout_count = 0;
  LadderReadout<T> *readouts;  ///< Sorted by element and offset.

  // The load.
  int contact_count = 0;
  LadderContact<T> *contacts;  ///< Sorted by element and offset.

  // The state, Newton's step and, with kLoad, the derivative by the load.
  LadderNodes<T> state, step, by_load;

  // The results of Evaluate.
  T *slot_x, *slot_y;
  T *slot_theta, *slot_moment, *slot_fx, *slot_fy;  ///< At the slot's start.
  T *slot_length, *slot_stiffness, *slot_axial;
  T *maps, *truncation;
  T *gap;      ///< Four an element, at its start.
  T *closure;  ///< Ribs, then six at the tip.
  /// (x, y, theta) of the front beam's end.
  T tip[3];
  T residual;  ///< The largest one; NaN if any is NaN.
  T *rib_ux, *rib_uy, *rib_distance;
  T *joints;                         ///< kJointValues a rib; only if joined.
  int *first_readout, *end_readout;  ///< The readouts of each slot.
  T *readout_map;

  // The results of Sweep: rows of `stride` columns [six parameters, or all of q
  // | the constant of the step | derivatives]. After a closed sweep the taps
  // hold, from column `affine` on, the changes of (x, y, theta) of each contact
  // and of the tip and of the readouts. After an open one rib lengths and the
  // six equations of the tip follow, all with their derivatives by q.
  int affine = 6, stride = 8, node_columns = kNodeColumns;
  /// With kParameters, columns of effects behind those of the rib lengths. Each
  /// effect begins at its number among them; a negative number means none.
  int effects = 0, by_hinge_stiffness = -1, by_rib_bending = -1,
      by_friction = -1, by_piece[2] = {-1, -1}, by_clamp[2] = {-1, -1},
      by_back_angle = -1, by_surface = -1;
  int event_count = 0;
  T *taps;
  T *q_step;  ///< Rows of the change of q.

  /// The input of Combine: the share of Newton's step, and the change of
  /// (l_c, f_c) of each contact.
  T newton;
  T change[2 * kFittedContacts];

  // The sweep's own memory.
  T *rows, *tip_rows, *node_rows, *pivots, *parameters;
  int *pivot_column, *pivot_rib, *events;
  T *pivot_flexibility;

  /// The elements of a beam, from `first` to before `end`.
  int first(int side) const { return side == 0 ? 0 : front_elements; }
  int end(int side) const { return side == 0 ? front_elements : elements; }
  /// The number of values of a state, which lie one behind the other from its
  /// `q` on.
  int state_size() const { return 6 + ribs + 4 * elements; }
  int slots() const { return elements + contact_count; }
  int contact_tap(int c) const { return 3 * c; }
  int tip_tap() const { return 3 * contact_count; }
  int readout_tap(int i) const { return tip_tap() + 3 + i; }
  int closure_tap() const { return readout_tap(readout_count); }
  int taps_count() const { return closure_tap() + ribs + 6; }
};

}  // namespace finray

#endif  // FINRAY_LADDER_LADDER_FRAME_H_
