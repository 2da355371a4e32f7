#ifndef FINRAY_FINGER_PARAMETER_COVARIANCE_H_
#define FINRAY_FINGER_PARAMETER_COVARIANCE_H_

#include <Eigen/Core>
#include <vector>

#include "finray/finger/finger_parameter.h"

namespace finray {

/// The covariance of a finger's parameters after a calibration,
///
///   C_ij = std_i std_j correlation_ij,
///
/// in the units of their names. A parameter that is not listed counts as
/// exactly known.
struct ParameterCovariance {
  /// An eigenvalue may be this far below 0, as rounding correlations to six
  /// digits can make it.
  static constexpr double kRounding = 1e-6;

  std::vector<FingerParameter> parameters;
  Eigen::VectorXd std;
  Eigen::MatrixXd correlations;  ///< Symmetric, 1 on the diagonal.

  /// The smallest eigenvalue of the correlations.
  double SmallestEigenvalue() const;
  /// F with F F' = C. Negative eigenvalues count as 0.
  Eigen::MatrixXd Factor() const;
};

}  // namespace finray

#endif  // FINRAY_FINGER_PARAMETER_COVARIANCE_H_
