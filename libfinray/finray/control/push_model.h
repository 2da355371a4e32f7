#ifndef FINRAY_CONTROL_PUSH_MODEL_H_
#define FINRAY_CONTROL_PUSH_MODEL_H_

#include <Eigen/Core>
#include <optional>

#include "finray/chain/se2.h"
#include "finray/statics/equilibrium.h"

namespace finray {

/// A circle pressed against a finger.
struct Push {
  double object_x_mm;         ///< of the circle's centre, in the world
  double arc_mm;              ///< l_c
  double stiffness_N_per_mm;  ///< df/dx of the contact, the circle's y held
};

/// The contact stiffness of a finger: the x at which a circle of radius R
/// causes a given force f. In frame S the circle that touches at l_c has the
/// centre
///
///   c(l_c, f) = r - R n,    n = (sin(theta), -cos(theta)),
///
/// with r and theta of the front beam at l_c. For a finger whose base is at T
/// and a circle at the height y, Newton's method solves [T c(l_c, f)]_y = y for
/// l_c. Then x = [T c]_x and, at constant y,
///
///   dx/df = x_f - x_l y_f / y_l
///
/// with the sensitivities of the statics. An object of unknown shape has the
/// radius 0, a point that slides along the finger.
class PushModel {
 public:
  PushModel(const Finger& finger, double radius_mm, double friction,
            const Discretization& discretization);

  /// The circle's centre in the world under a contact; nothing if there is no
  /// equilibrium.
  std::optional<Eigen::Vector2d> Centre(const Pose<double>& base, double arc_mm,
                                        double normal_N);

  /// The push with a given force at the height y, found from `arc_mm` on;
  /// nothing if the beam has no such contact.
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
