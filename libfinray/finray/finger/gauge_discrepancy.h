#ifndef FINRAY_FINGER_GAUGE_DISCREPANCY_H_
#define FINRAY_FINGER_GAUGE_DISCREPANCY_H_

#include <Eigen/Core>
#include <vector>

namespace finray {

/// What the model of a calibrated finger still misses: the covariance of the
/// gauge angles, rad^2, about those that it predicts for a contact at l_c with
/// the force f_c,
///
///   S(l_c, f_c) = (1 + (f_c / load)^2) A(l_c),
///
/// with A linear between places and constant beyond the outer ones. Errors of
/// several contacts add up. It widens std and never moves an estimate.
struct GaugeDiscrepancy {
  struct Place {
    double place_mm;                  ///< Arc length on the front beam.
    Eigen::MatrixXd covariance_rad2;  ///< A there, gauges x gauges.
  };
  double load_N = 1;
  std::vector<Place> places;  ///< From base to tip; at least one.

  /// Adds S to a matrix of gauges x gauges. It allocates nothing.
  void AddTo(double arc_mm, double normal_N, Eigen::MatrixXd* covariance) const;
};

}  // namespace finray

#endif  // FINRAY_FINGER_GAUGE_DISCREPANCY_H_
