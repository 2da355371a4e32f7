#ifndef FINRAY_OBJECTS_OBJECT_CONTACT_H_
#define FINRAY_OBJECTS_OBJECT_CONTACT_H_

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "finray/objects/outline.h"
#include "finray/statics/shape.h"

namespace finray {

/// A spring that lets an object slide, without turning, along a line through
/// its given place.
struct ObjectSpring {
  double stiffness_N_per_mm;
  double direction_rad;  ///< Direction of the line, from +x.
};

/// A rigid convex object on the outer side (-x) of the front beam.
struct RigidObject {
  Outline outline;
  std::optional<ObjectSpring> spring;  ///< Without it the object is held.
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
  /// Displacement of the object along its spring, 0 without a spring.
  double displacement_mm = 0;
};

/// A point of the front beam counts as inside the object if it lies deeper than
/// this share of l_0.
constexpr double kContactDepthTolerance = 5e-9;

/// Finds the equilibrium of the finger against an object at a known place:
/// points l_c and forces f_c >= 0 where the object touches the front beam, with
/// no point of the beam inside the object. With d(r) the distance of a point
/// from the outline, n_o the outward normal at the nearest outline point, and t
/// the tangent of the beam at the contact point r,
///
///   d(r(l_c)) = 0,    t(l_c) . n_o(r(l_c)) = 0,
///
/// so n_o is the beam's normal n. On a spring of stiffness k along e the
/// contact forces push the object away from the given place p:
///
///   centre = p + u e,    u = -e . sum f_c (n + mu t) / k.
///
/// If `guess` has contacts, it starts from the solver's present state with
/// them. Without a guess, or if that fails, it moves the object in from first
/// touch. It leaves the solver at the equilibrium found, with sensitivities if
/// there is contact; for kNoContact at the free finger.
ObjectContact SolveObjectContact(const RigidObject& object,
                                 const ObjectPose& pose, double friction,
                                 EquilibriumSolver* solver,
                                 const std::vector<PointContact>& guess = {});

}  // namespace finray

#endif  // FINRAY_OBJECTS_OBJECT_CONTACT_H_
