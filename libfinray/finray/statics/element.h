#ifndef FINRAY_STATICS_ELEMENT_H_
#define FINRAY_STATICS_ELEMENT_H_

namespace finray {

// The beam equation of a bay. Between ribs, contacts and the ends of a beam the
// internal force N is constant, so the state (x, y, theta, M) obeys
//
//   x' = cos(theta),  y' = sin(theta),  theta' = M / EI,
//   M' = -(t x N) = N_x sin(theta) - N_y cos(theta),
//
// with M and N the moment and force that the part towards the tip exerts on the
// part towards the base. An element carries the state over a length h. Each
// scheme is a class with the members of TaylorElement and RigidLinkElement:
//
//   void Compute(const ElementStart&, double stiffness, double length);
//   const ElementMap& map() const;
//   AngleReadout AngleAt(double offset) const;     // inside the element
//   BeamPoint PointAt(double offset) const;

/// What an element starts from; position does not matter.
struct ElementStart {
  double theta_rad;
  double moment_N_mm;
  double force_x_N;
  double force_y_N;
};

/// The state at the end of an element: (x - x_start, y - y_start, theta, M),
/// and its derivatives. These are exact derivatives of the discrete scheme.
struct ElementMap {
  double end[4];
  double d_start[4][4];   ///< by (theta, M, N_x, N_y) at the start.
  double d_stiffness[4];  ///< by EI.
  double d_length[4];     ///< by h.
};

/// Tangent angle inside an element with its derivatives.
struct AngleReadout {
  double theta_rad;
  double d_start[4];  ///< by (theta, M, N_x, N_y) at the start.
  double d_stiffness;
  double d_offset;
  double d_length;  ///< by h at a fixed offset.
};

/// A point of a deformed beam.
struct BeamPoint {
  double x_mm;
  double y_mm;
  double theta_rad;
  double moment_N_mm;
};

}  // namespace finray

#endif  // FINRAY_STATICS_ELEMENT_H_
