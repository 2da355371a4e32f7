#ifndef FINRAY_TESTS_STATICS_STRAIN_ENERGY_H_
#define FINRAY_TESTS_STATICS_STRAIN_ENERGY_H_

#include <algorithm>
#include <cmath>
#include <vector>

#include "finray/finger/geometry.h"
#include "finray/statics/shape.h"
#include "statics/equilibrium_values.h"
#include "statics/gauss_legendre.h"

namespace finray {

/// What a finger in equilibrium stores: bending and stretching of the beams,
/// piece by piece, and of the ribs. N mm.
inline double StrainEnergy(const EquilibriumSolver& solver,
                           const std::vector<PointContact>& contacts) {
  const Finger& finger = solver.model().finger();
  const Shape shape(solver, contacts);
  double energy = 0;
  for (const Side side : {Side::kFront, Side::kBack}) {
    const std::vector<StiffnessPiece>& pieces = Pieces(finger, side);
    const std::vector<double> stations = Stations(solver, contacts, side);
    for (std::size_t k = 0; k + 1 < stations.size(); ++k) {
      for (const QuadraturePoint& q :
           GaussLegendre(8, stations[k], stations[k + 1])) {
        const Section at = shape.At(side, q.at);
        const auto piece = std::find_if(
            pieces.begin(), pieces.end(),
            [&](const StiffnessPiece& p) { return q.at < p.end_mm; });
        const double bending =
            BendingStiffness(finger, side) *
            (piece == pieces.end() ? 1 : piece->stiffness_ratio);
        const double tension = at.force_x_N * std::cos(at.theta_rad) +
                               at.force_y_N * std::sin(at.theta_rad);
        energy +=
            q.weight * (at.moment_N_mm * at.moment_N_mm / (2 * bending) +
                        tension * tension / (2 * AxialStiffness(finger, side)));
      }
    }
  }
  for (std::size_t i = 0; i < finger.ribs.size(); ++i) {
    const double tension = solver.rib_tension(static_cast<int>(i));
    energy += tension * tension * finger.ribs[i].length_mm /
              (2 * finger.ribs[i].axial_stiffness_N);
  }
  return energy;
}

}  // namespace finray

#endif  // FINRAY_TESTS_STATICS_STRAIN_ENERGY_H_
