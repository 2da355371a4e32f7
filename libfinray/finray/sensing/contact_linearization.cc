#include "finray/sensing/contact_linearization.h"

#include <cmath>

#include "finray/objects/circle_centre.h"

namespace finray {

bool ContactLinearization::At(const std::vector<PointContact>& contacts,
                              const PackedReadings& measurement,
                              std::optional<double> circle_radius_mm,
                              EquilibriumSolver* solver) {
  if (!solver->SolveWithSensitivities(contacts)) return false;
  const auto unknowns = static_cast<Eigen::Index>(2 * contacts.size());
  const Eigen::Index gauges = solver->model().gauges();
  residual = -measurement.values;
  slope.resize(residual.size(), unknowns);
  residual.head(gauges) += solver->outputs().head(gauges);
  slope.topRows(gauges) = solver->d_outputs().topLeftCorner(gauges, unknowns);
  if (circle_radius_mm) {
    const Eigen::Vector3d pose = solver->contact_pose(0);
    residual.tail<2>() += CircleCentre(pose, *circle_radius_mm);
    slope.bottomRows<2>() =
        solver->d_outputs().block(gauges, 0, 2, unknowns) +
        CircleCentreByAngle(pose[2], *circle_radius_mm) *
            solver->d_outputs().block(gauges + 2, 0, 1, unknowns);
  }
  residual.array() *= measurement.weights.array();
  slope.array().colwise() *= measurement.weights.array();
  return std::isfinite(chi2());
}

}  // namespace finray
