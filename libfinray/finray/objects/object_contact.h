#ifndef FINRAY_OBJECTS_OBJECT_CONTACT_H_
#define FINRAY_OBJECTS_OBJECT_CONTACT_H_

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "finray/objects/outline.h"
#include "finray/statics/equilibrium.h"

namespace finray {

/// Lets an object slide along a line through its given place, against a force
/// of `stiffness_N_per_mm` times the way; it does not turn.
struct ObjectSpring {
  double stiffness_N_per_mm;
  double direction_rad;  ///< of the line, from +x.
};

/// A rigid convex object on the outer side (-x) of the front beam.
struct RigidObject {
  Outline outline;
  std::optional<ObjectSpring> spring;  ///< Nothing: held rigidly.
};

enum class ObjectContactStatus {
  kContact,
  kNoContact,     ///< The unloaded finger does not reach into the object.
  kNoTangency,    ///< The object meets an end of the beam, not its side.
  kNotConverged,  ///< No equilibrium was found.
};

struct ObjectContact {
  ObjectContactStatus status = ObjectContactStatus::kNoContact;
  /// From base to tip, forces > 0. A stretch along which the beam follows the
  /// outline appears as several contacts.
  std::vector<PointContact> contacts;
  /// Way of the object along its spring's direction, 0 without a spring.
  double displacement_mm = 0;
};

/// No point of the front beam lies deeper inside the object than this share of
/// l_0; an object that the free finger reaches into by less is not touched.
constexpr double kContactDepthTolerance = 5e-9;

/// Finds the equilibrium of the finger against an object of known place: points
/// l_c and forces f_c >= 0 such that the object touches the front beam there
/// and no point of the beam lies inside it. With d(r) the distance of a point
/// from the outline, n_o the outline's outward normal nearest to it, and t the
/// tangent of the beam at the contact point r,
///
///   d(r(l_c)) = 0,    t(l_c) . n_o(r(l_c)) = 0,
///
/// so that n_o is the beam's normal n. On a spring of stiffness k along e the
/// object is where the forces on it push it from the given place p,
///
///   centre = p + u e,    u = -e . sum f_c (n + mu t) / k.
///
/// Tries the solver's present state with `guess` if that has contacts, else
/// moves the object in from first touch. The solver is left at the equilibrium,
/// with sensitivities if there is contact, at the free one for kNoContact.
ObjectContact SolveObjectContact(const RigidObject& object,
                                 const ObjectPose& pose, double friction,
                                 EquilibriumSolver* solver,
                                 const std::vector<PointContact>& guess = {});

}  // namespace finray

#endif  // FINRAY_OBJECTS_OBJECT_CONTACT_H_
