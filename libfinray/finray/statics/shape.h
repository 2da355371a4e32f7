#ifndef FINRAY_STATICS_SHAPE_H_
#define FINRAY_STATICS_SHAPE_H_

#include <array>
#include <vector>

#include "finray/statics/equilibrium.h"

namespace finray {

/// Geometry and internal loads at one section of a deformed beam. The part
/// towards the tip exerts the moment and force on the part towards the base.
struct Section {
  double x_mm;
  double y_mm;
  double theta_rad;
  double moment_N_mm;
  double force_x_N;
  double force_y_N;
};

/// The deformed finger after a solve, readable at any arc length. Later solves
/// do not change it.
class Shape {
 public:
  /// `contacts` must be those of the solver's last solve. Throws
  /// std::logic_error if that solve found no equilibrium.
  Shape(const EquilibriumSolver& solver,
        const std::vector<PointContact>& contacts)
      : Shape(solver, contacts, 2) {}
  /// The front beam alone takes half the time. At must not be asked for the
  /// back beam then.
  static Shape OfFront(const EquilibriumSolver& solver,
                       const std::vector<PointContact>& contacts) {
    return {solver, contacts, 1};
  }

  /// At a rib or contact, where internal forces jump, it gives the values on
  /// the side towards the tip, and at the tip itself those before it.
  Section At(Side side, double arc_mm) const;
  /// The same with the place of the beam's surface (Finger::front_surface_mm).
  Section SurfaceAt(Side side, double arc_mm) const;

 private:
  // Takes the first `sides` beams, front and back.
  Shape(const EquilibriumSolver& solver,
        const std::vector<PointContact>& contacts, int sides);

  // A piece of a beam. (x, y, theta, M) are polynomials of the arc length from
  // its start.
  struct Piece {
    double arc_mm;
    double force_x_N, force_y_N;
    std::size_t first_coefficient;
  };

  int degree_ = 0;
  std::array<double, 2> lift_mm_;  // of the surface, to the left
  std::array<std::vector<Piece>, 2> pieces_;
  std::vector<double> coefficients_;  // four a power, lowest power first
};

}  // namespace finray

#endif  // FINRAY_STATICS_SHAPE_H_
