#ifndef FINRAY_OBJECTS_TANGENCY_H_
#define FINRAY_OBJECTS_TANGENCY_H_

#include <Eigen/Core>
#include <vector>

#include "finray/objects/object_contact.h"

namespace finray {

/// The unknowns that make a set of contacts touch an object.
enum class TangencyUnknowns {
  kPlacesAndForces,  ///< l_c and f_c; the object is touched tangentially.
  kForces,           ///< f_c; the contact points lie on the outline.
};

/// Solves the equations of object_contact.h for a given set of contacts, whose
/// forces may have any sign, by Newton's method with exact derivatives. Each
/// evaluation is an equilibrium of the finger.
class Tangency {
 public:
  Tangency(const RigidObject& object, double friction,
           EquilibriumSolver* solver);

  /// Solves from the solver's present state and `*contacts`. False if it does
  /// not converge or if the object ends up on the finger's side of the beam.
  bool Solve(const ObjectPose& pose, TangencyUnknowns unknowns,
             std::vector<PointContact>* contacts);

  /// Evaluates the equations at the solver's equilibrium, which must have
  /// sensitivities, under `contacts`.
  void Linearize(const ObjectPose& pose,
                 const std::vector<PointContact>& contacts);

  // Results of the last evaluation.

  /// The largest distance of a contact point from the outline.
  double largest_gap_mm() const;
  /// Displacement of the object along its spring.
  double displacement_mm() const { return displacement_mm_; }
  void ResetDisplacement() { displacement_mm_ = 0; }
  /// The displaced pose of an object that was given at `pose`.
  ObjectPose Displaced(ObjectPose pose) const;

  /// Equilibria solved so far.
  int equilibria() const { return equilibria_; }

 private:
  void Push(const std::vector<PointContact>& contacts);

  const RigidObject& object_;
  const double friction_;
  EquilibriumSolver* const solver_;
  const double length_;
  Eigen::Vector2d direction_ = Eigen::Vector2d::Zero();  // of the spring

  double displacement_mm_ = 0;
  int equilibria_ = 0;
  // Rows [d of each contact; t . n_o of each], columns [l_c of each; f_c of
  // each].
  Eigen::VectorXd residual_;
  Eigen::MatrixXd jacobian_;
  Eigen::MatrixXd d_pose_;  // of (x, y, theta) of each contact
  Eigen::RowVectorXd d_displacement_;
  bool outside_ = false;  // the beam's normals point out of the object
};

}  // namespace finray

#endif  // FINRAY_OBJECTS_TANGENCY_H_
