#ifndef FINRAY_FINGER_PARAMETER_COVARIANCE_H_
#define FINRAY_FINGER_PARAMETER_COVARIANCE_H_

#include <Eigen/Core>
#include <vector>

#include "finray/finger/finger_parameter.h"

namespace finray {

/// How well a calibration knows the parameters of a finger,
///
///   C_ij = std_i std_j correlation_ij,
///
/// in the units of their names. What is not listed counts as known.
struct ParameterCovariance {
  /// Correlations written with six digits are taken for a covariance.
  static constexpr double kRounding = 1e-6;

  std::vector<FingerParameter> parameters;
  Eigen::VectorXd std;
  Eigen::MatrixXd correlations;  ///< symmetric, 1 on the diagonal

  double SmallestEigenvalue() const;  ///< of the correlations
  /// F with F F' = C, an eigenvalue that rounding has made negative being 0.
  Eigen::MatrixXd Factor() const;
};

}  // namespace finray

#endif  // FINRAY_FINGER_PARAMETER_COVARIANCE_H_
