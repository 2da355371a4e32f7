#ifndef FINRAY_LADDER_LADDER_FRAME_H_
#define FINRAY_LADDER_LADDER_FRAME_H_

namespace finray {

// What the ladder kernel (ladder_kernel.h) works on: plain arrays, as its code
// is compiled for several instruction sets and must not share inline functions
// of a library with the rest. All numbers are in units of l_0, EI_0 / l_0 and
// EI_0 / l_0^2, EI_0 = sqrt(EI_front EI_back), which makes them comparable when
// pivots are chosen.
//
// Elements are numbered front beam first, base to tip, then the back beam. A
// slot is a piece of an element: the element up to its first contact has the
// element's number, what follows contact c has number elements + c.
//
// T is double or float, and vector lanes are elements (evaluation) and columns
// (sweep) of one frame; or it is FourFrames of lanes.h, each number being one
// of each of four frames, which share mesh, pivots and what else is an integer
// here. The code is the same. Numbers are aligned to their size, which not
// every instruction set does of itself; so no local variable goes to the
// kernel.

/// Which derivatives a sweep carries beside the Newton step.
enum class SweepColumns {
  kNone,
  kContacts,    ///< l_c, f_c of each contact.
  kParameters,  ///< l_c, f_c of each contact; EI front, back; rib lengths.
  kLoad,        ///< the load factor: contact forces and rib lengths together.
};

/// A contact at its place in the mesh.
template <class T>
struct LadderContact {
  int side;  ///< 0 front, 1 back.
  int element;
  int index;    ///< the caller's number of it.
  int columns;  ///< the number of its derivatives by (l_c, f_c).
  alignas(sizeof(T)) T offset;  ///< from the start of the element.
  T normal;
  T friction;
  T d_normal;  ///< by the load factor.
  T present;   ///< 0 in frames that have no contact in this element, else 1.
};

/// Where one end of a gauge reads its beam's angle.
template <class T>
struct LadderReadout {
  int gauge;
  int sign;
  int element;
  alignas(sizeof(T)) T offset;
};

/// Base moments and forces and rib tensions (q of ladder.h), and (x, y, theta,
/// M) at the start of each element.
template <class T>
struct LadderNodes {
  T *q, *x, *y, *theta, *moment;
};

/// One evaluation of an element, as BasicElementMap, lanes innermost.
constexpr int kMapEnd = 0, kMapStart = 4, kMapStiffness = 20, kMapLength = 24,
              kMapValues = 28;
/// One readout: angle, its derivatives by the start, EI, offset and length.
constexpr int kReadoutValues = 8;
/// Columns needed of each node's rows: six parameters, the step, and
/// derivatives by the load or by up to kFittedContacts contacts.
constexpr int kNodeColumns = 8, kMostNodeColumns = 16;
constexpr int kFittedContacts = 2;
/// Elements between two looks at the growth of a sweep's columns; none grows by
/// more than a few.
constexpr int kGrowthCheckEvery = 4;

template <class T>
struct LadderFrame {
  // The finger and its mesh.
  int front_elements = 0, elements = 0, ribs = 0;
  alignas(sizeof(T)) T base_x[2] = {}, base_angle[2] = {};
  T *length, *stiffness, *stiffness_ratio, *axial_flexibility;
  int *rib_element[2];  ///< the element that starts at the hinge.
  T *rib_length, *rib_flexibility, *d_rib_length;
  int readout_count = 0;
  LadderReadout<T> *readouts;  ///< by element and offset.

  // The load.
  int contact_count = 0;
  LadderContact<T> *contacts;  ///< by element and offset.

  // The state, Newton's step and, with kLoad, the derivative by the load.
  LadderNodes<T> state, step, by_load;

  // What evaluation leaves.
  T *slot_x, *slot_y;
  T *slot_theta, *slot_moment, *slot_fx, *slot_fy;  ///< starts
  T *slot_length, *slot_stiffness, *slot_axial;
  T *maps, *truncation;
  T *gap;      ///< four an element, at its start.
  T *closure;  ///< ribs, then six at the tip.
  /// (x, y, theta) of the front beam's end.
  alignas(sizeof(T)) T tip[3];
  alignas(sizeof(T)) T residual;  ///< the largest, NaN if any is.
  T *rib_ux, *rib_uy, *rib_distance;
  int *first_readout, *end_readout;  ///< the readouts of each slot.
  T *readout_map;

  // What a sweep leaves: rows of `stride` columns [six parameters, or all of q
  // | the constant of the step | derivatives]. After a closed sweep the taps
  // hold, from column `affine` on, the change of (x, y, theta) of each contact
  // and of the tip and of the readouts; after an open one rib lengths and the
  // six equations of the tip follow, all with their derivatives by q.
  int affine = 6, stride = 8, node_columns = kNodeColumns;
  int event_count = 0;
  T *taps;
  T *q_step;  ///< rows of the change of q.

  /// What Combine takes: the share of Newton's step, and by how much each
  /// contact is moved, (l_c, f_c).
  alignas(sizeof(T)) T newton;
  alignas(sizeof(T)) T change[2 * kFittedContacts];

  // The sweep's own memory.
  T *rows, *tip_rows, *node_rows, *pivots, *parameters;
  int *pivot_column, *pivot_rib, *events;
  T *pivot_flexibility;

  int slots() const { return elements + contact_count; }
  int contact_tap(int c) const { return 3 * c; }
  int tip_tap() const { return 3 * contact_count; }
  int readout_tap(int i) const { return tip_tap() + 3 + i; }
  int closure_tap() const { return readout_tap(readout_count); }
  int taps_count() const { return closure_tap() + ribs + 6; }
};

}  // namespace finray

#endif  // FINRAY_LADDER_LADDER_FRAME_H_
