#ifndef FINRAY_SENSING_CONTACT_LINEARIZATION_H_
#define FINRAY_SENSING_CONTACT_LINEARIZATION_H_

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "finray/sensing/contact_covariance.h"
#include "finray/sensing/packed_readings.h"
#include "finray/statics/equilibrium.h"

namespace finray {

/// What contacts in equilibrium would have measured, against what was: whitened
/// residuals w (s(l_c, f_c) - measured) and their slopes by (l_c, f_c) of each
/// contact, per mm and N.
struct ContactLinearization {
  Eigen::VectorXd residual;
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, Eigen::Dynamic,
                2 * kFittedContacts>
      slope;

  double chi2() const { return residual.squaredNorm(); }
  ContactMatrix information() const { return slope.transpose() * slope; }

  /// Solves the equilibrium, from the solver's present state, and fills this.
  /// False if there is none.
  bool At(const std::vector<PointContact>& contacts,
          const PackedReadings& measurement,
          std::optional<double> circle_radius_mm, EquilibriumSolver* solver);
};

}  // namespace finray

#endif  // FINRAY_SENSING_CONTACT_LINEARIZATION_H_
