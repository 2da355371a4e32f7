#ifndef FINRAY_STATICS_CIRCLE_CONTACT_H_
#define FINRAY_STATICS_CIRCLE_CONTACT_H_

#include <Eigen/Core>

#include "finray/statics/equilibrium.h"

namespace finray {

/// A rigid circular object on the outer side (-x) of the front beam.
struct Circle {
  Eigen::Vector2d center_mm;
  double radius_mm;
};

enum class CircleContactStatus {
  kContact,
  kNoContact,     ///< The unloaded finger does not reach into the circle.
  kNoTangency,    ///< The circle meets an end of the beam, not its side.
  kNotConverged,  ///< No equilibrium was found.
};

/// Finds the equilibrium of the finger against a circle of known centre. Its
/// two unknowns l_c and f_c follow from tangency: with r the contact point and
/// n the local normal into the finger,
///
///   r(l_c, f_c) - R n(l_c, f_c) = centre.
///
/// Tries the solver's present state with `*contact` as the guess if its force
/// is positive, else moves the circle in from first touch. On kContact,
/// `*contact` holds l_c and f_c and the solver the equilibrium, with
/// sensitivities.
CircleContactStatus SolveCircleContact(const Circle& circle, double friction,
                                       EquilibriumSolver* solver,
                                       PointContact* contact);

/// How deep the circle reaches into the free finger, and where.
struct CircleTouch {
  double arc_mm;    ///< The point of the free front beam nearest to the centre.
  double depth_mm;  ///< > 0: overlap; < 0: gap.
  double distance_mm;      ///< of that point from the centre.
  bool tangent;            ///< false if that point is an end of the beam.
  Eigen::Vector2d normal;  ///< Into the finger.
};
CircleTouch FindTouch(const Circle& circle, const EquilibriumSolver& free);

}  // namespace finray

#endif  // FINRAY_STATICS_CIRCLE_CONTACT_H_
