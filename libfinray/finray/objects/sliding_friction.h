#ifndef FINRAY_OBJECTS_SLIDING_FRICTION_H_
#define FINRAY_OBJECTS_SLIDING_FRICTION_H_

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "finray/objects/object_contact.h"

namespace finray {

/// The friction of an object that moves along the front beam, row by row. The
/// contact pulls by z mu f_c along the tangent, with a state z of -1 to 1 that
/// follows the object's slip s over the beam (Dahl's law):
///
///   dz = (sgn(ds) - z) |ds| / s_0,
///   z_k = sgn(s) + (z_{k-1} - sgn(s)) exp(-|s| / s_0),  s = s_k - s_{k-1}.
///
/// s_0 is the presliding displacement, in which friction turns round. Towards
/// the tip s > 0, so friction pulls towards the tip where the object goes
/// there. With the contact at l_c and r, the object at p, turned by psi, and
/// the tangent t midway between both rows,
///
///   s = dl_c + t . (dp - dr + dpsi z x (r - p)),
///
/// which for a circle of radius R is dl_c - R (dtheta - dpsi). Friction holds
/// the finger back: the equilibrium at z_k gives s, and s gives z_k. Both are
/// solved together, and a contact whose slip the finger's give takes up sticks.
///
/// A touch begins with z = 0 where the object, pressed in straight, first meets
/// the free finger. It ends in a row without contact, or where the object is
/// more than kLifted_mm further along the beam: it was lifted in between.
class SlidingFriction {
 public:
  static constexpr double kLifted_mm = 5;
  /// A coordinate of the object counts as moved once it is this many std of a
  /// difference of two measurements away from where it moved last. Slips of
  /// 0.01 mm decide, and a stage moves along one axis at a time.
  static constexpr double kMoves = 3;

  /// `object_std_mm` is that of the object's measured coordinates, 0 if its
  /// place is exact. Below 0 the coefficient counts as 0.
  SlidingFriction(const RigidObject& object, double coefficient,
                  double presliding_mm, double object_std_mm);

  /// Takes the next row and returns z mu; nothing if the object does not touch
  /// the finger at one point, or has no place. It leaves the solver at the
  /// row's equilibrium. That of the next row starts from there, so it should be
  /// the same one.
  std::optional<double> Next(const ObjectPose& measured,
                             EquilibriumSolver* solver);
  /// z of the last row.
  double state() const { return state_; }
  /// The object of the last row; kNotConverged before the first one.
  const ObjectContact& contact() const { return contact_; }
  /// The next row is the first of a touch.
  void Lift() { touches_ = false; }

 private:
  // Where the contact of a row is.
  struct Place {
    double arc_mm, theta_rad;
    Eigen::Vector2d point_mm, object_mm;
    double object_rad;
  };
  ObjectPose Held(const ObjectPose& measured);
  bool Begin(const ObjectPose& pose, EquilibriumSolver* solver);
  bool Solve(const ObjectPose& pose, double state, EquilibriumSolver* solver,
             Place* place);
  double Slip(const Place& place) const;
  double StateAfter(double slip) const;
  bool FindState(const ObjectPose& pose, EquilibriumSolver* solver,
                 double* state, Place* place);

  RigidObject object_;
  double coefficient_, presliding_mm_, moves_mm_;
  ObjectContact contact_{ObjectContactStatus::kNotConverged, {}, 0};
  bool touches_ = false;
  ObjectPose held_;
  Place last_{};
  double state_ = 0;
};

}  // namespace finray

#endif  // FINRAY_OBJECTS_SLIDING_FRICTION_H_
