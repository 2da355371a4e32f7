#ifndef FINRAY_CONTROL_PUSH_MODEL_H_
#define FINRAY_CONTROL_PUSH_MODEL_H_

#include <Eigen/Core>
#include <optional>

#include "finray/chain/se2.h"
#include "finray/statics/equilibrium.h"

namespace finray {

/// A circle pressed against a finger, by the finger's model.
struct Push {
  double object_x_mm;         ///< of the circle's centre, in the world
  double arc_mm;              ///< l_c
  double stiffness_N_per_mm;  ///< df/dx of the contact, the circle's y held
};

/// The finger's own contact stiffness: where a circle of radius R has to be
/// along x so that the finger feels a given force. Touched at l_c with force f
/// its centre is, in frame S,
///
///   c(l_c, f) = r - R n,    n = (sin(theta), -cos(theta)),
///
/// r and theta being the front beam's there. With the finger's base at T and
/// the circle's y given, l_c follows from [T c(l_c, f)]_y = y by Newton's
/// method; x = [T c]_x, and along that line
///
///   dx/df = x_f - x_l y_f / y_l,
///
/// with the sensitivities of the statics. A radius of 0 is a point that slides
/// along the finger: for an object of unknown shape.
class PushModel {
 public:
  PushModel(const Finger& finger, double radius_mm, double friction,
            const Discretization& discretization);

  /// The circle's centre in the world under a contact; nothing if there is no
  /// equilibrium.
  std::optional<Eigen::Vector2d> Centre(const Pose<double>& base, double arc_mm,
                                        double normal_N);

  /// Nothing if there is no such contact on the beam. Starts from `arc_mm`.
  std::optional<Push> At(const Pose<double>& base, double y_mm, double normal_N,
                         double arc_mm);

 private:
  bool Solve(const Pose<double>& base, double arc_mm, double normal_N);

  EquilibriumSolver solver_;
  double radius_mm_, friction_;
  // At the last equilibrium, in the world.
  Eigen::Vector2d centre_, by_arc_, by_force_;
};

}  // namespace finray

#endif  // FINRAY_CONTROL_PUSH_MODEL_H_
