#ifndef FINRAY_STATICS_SHAPE_H_
#define FINRAY_STATICS_SHAPE_H_

#include <array>
#include <vector>

#include "finray/statics/equilibrium.h"

namespace finray {

/// Geometry and internal loads at one section of a deformed beam. Moment and
/// force are what the part towards the tip exerts on the part towards the base.
struct Section {
  double x_mm;
  double y_mm;
  double theta_rad;
  double moment_N_mm;
  double force_x_N;
  double force_y_N;
};

/// The deformed finger after a solve, readable at any arc length. It is a
/// snapshot: later solves do not change it.
class Shape {
 public:
  /// `contacts` are those of the solver's last solve. Throws std::logic_error
  /// if that found no equilibrium.
  Shape(const EquilibriumSolver& solver,
        const std::vector<PointContact>& contacts);

  /// Where internal forces jump (ribs, contacts) the side towards the tip is
  /// given, at the tip itself the one before it.
  Section At(Side side, double arc_mm) const;

  /// Arc lengths between which the beam is smooth, base to tip.
  std::vector<double> Stations(Side side) const;

 private:
  // A piece of a beam, its (x, y, theta, M) polynomials of the arc length from
  // its start.
  struct Piece {
    double arc_mm, length_mm;
    double force_x_N, force_y_N;
    std::size_t first_coefficient;
  };

  int degree_ = 0;
  std::array<std::vector<Piece>, 2> pieces_;
  std::vector<double> coefficients_;  // four a power, rising powers
};

}  // namespace finray

#endif  // FINRAY_STATICS_SHAPE_H_
