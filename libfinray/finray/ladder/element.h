#ifndef FINRAY_LADDER_ELEMENT_H_
#define FINRAY_LADDER_ELEMENT_H_

namespace finray {

// The beam equation and what an element of it computes. Between ribs, contacts
// and the ends of a beam the internal force N is constant, so the state
// (x, y, theta, M) obeys
//
//   x' = (1 + e) cos(theta),  y' = (1 + e) sin(theta),  theta' = M / EI,
//   M' = -(1 + e) (t x N) = (1 + e) (N_x sin(theta) - N_y cos(theta)),
//   e  = (t . N) / EA,
//
// with M and N the moment and force that the part towards the tip exerts on the
// part towards the base, t the tangent and s the arc length of the unstretched
// beam. A beam that does not stretch has 1 / EA = 0. An element carries the
// state over a length h. The schemes TaylorElement and RigidLinkElement have
// the same members, for a value V (lanes.h) of any width:
//
//   void Solve(start, stiffness, axial_flexibility, length);
//   void SolveAndDifferentiate(the same);   // by the start of the element
//   void DifferentiateByStiffness();        // after SolveAndDifferentiate
//   void DifferentiateByLength();           // after SolveAndDifferentiate
//   const BasicElementMap<V>& map() const;
//   BasicAngleReadout<V> AngleAt(V offset) const;  // after the same; inside
//   void DenseOutput(V (*coefficients)[4]) const;  // kDegree + 1 rows
//   V Truncation() const;                     // of the angle at the end, rad

/// The state at the start of an element. Its position does not matter.
template <class V>
struct BasicElementStart {
  V theta_rad;
  V moment_N_mm;
  V force_x_N;
  V force_y_N;
};

/// The state at the end of an element, (x - x_start, y - y_start, theta, M),
/// and the exact derivatives of the discrete scheme.
template <class V>
struct BasicElementMap {
  V end[4];
  V d_start[4][4];   ///< by (theta, M, N_x, N_y) at the start.
  V d_stiffness[4];  ///< by EI.
  V d_length[4];     ///< by h.
};

/// The tangent angle inside an element with its derivatives.
template <class V>
struct BasicAngleReadout {
  V theta_rad;
  V d_start[4];  ///< by (theta, M, N_x, N_y) at the start.
  V d_stiffness;
  V d_offset;
  V d_length;  ///< by h at a fixed offset.
};

using ElementStart = BasicElementStart<double>;
using ElementMap = BasicElementMap<double>;
using AngleReadout = BasicAngleReadout<double>;

}  // namespace finray

#endif  // FINRAY_LADDER_ELEMENT_H_
