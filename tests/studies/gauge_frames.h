#ifndef FINRAY_TESTS_STUDIES_GAUGE_FRAMES_H_
#define FINRAY_TESTS_STUDIES_GAUGE_FRAMES_H_

#include <Eigen/Core>
#include <Eigen/LU>
#include <random>
#include <vector>

#include "finray/scene/clean_readings.h"
#include "finray/scene/measurements.h"
#include "finray/statics/equilibrium.h"

namespace finray {

inline Measurements WithNoise(Measurements readings, const Finger& finger,
                              std::mt19937_64* generator) {
  std::normal_distribution<double> unit;
  for (std::size_t j = 0; j < finger.gauges.size(); ++j) {
    readings.gauges_V[j] += finger.gauges[j].noise_V * unit(*generator);
  }
  return readings;
}

/// The Cramer-Rao bound of (l_c, f_c) of each contact, mm and N: the inverse of
///
///   sum_j (d alpha_j / d x)^T (gain_j / noise_j)^2 (d alpha_j / d x),
///
/// derivatives by central differences of equilibria, so that nothing of an
/// estimator is in it. Contacts are at least 1e-3 mm from the beam's ends.
/// Leaves the solver at the last equilibrium of the differences.
inline Eigen::MatrixXd CramerRaoCovariance(std::vector<PointContact> contacts,
                                           EquilibriumSolver* solver) {
  const std::vector<Gauge>& gauges = solver->model().finger().gauges;
  const int m = static_cast<int>(gauges.size());
  const int n = 2 * static_cast<int>(contacts.size());
  Eigen::MatrixXd slope(m, n);
  const auto angles = [&]() -> Eigen::VectorXd {
    return solver->Solve(contacts) ? Eigen::VectorXd(solver->outputs().head(m))
                                   : Eigen::VectorXd::Constant(m, std::nan(""));
  };
  for (int k = 0; k < n; ++k) {
    PointContact& contact = contacts[k / 2];
    double& x = k % 2 == 0 ? contact.arc_mm : contact.normal_N;
    const double at = x, step = k % 2 == 0 ? 1e-3 : 1e-4 * at;
    x = at + step;
    slope.col(k) = angles();
    x = at - step;
    slope.col(k) -= angles();
    slope.col(k) /= 2 * step;
    x = at;
  }
  for (int j = 0; j < m; ++j) {
    slope.row(j) *= gauges[j].AngleWeight();
  }
  return (slope.transpose() * slope).inverse();
}

}  // namespace finray

#endif  // FINRAY_TESTS_STUDIES_GAUGE_FRAMES_H_
