#ifndef FINRAY_RESIDUALS_PARAMETER_PRIOR_RESIDUAL_H_
#define FINRAY_RESIDUALS_PARAMETER_PRIOR_RESIDUAL_H_

#include <ceres/cost_function.h>

#include <Eigen/Core>

namespace finray {

/// What is known of a parameter block before the measurements:
///
///   r = (x - mean) / sigma, element by element,
///
/// a ceres::NormalPrior with a diagonal matrix. Parameter block: x.
struct ParameterPriorResidual {
  static ceres::CostFunction* Create(const Eigen::VectorXd& mean,
                                     const Eigen::VectorXd& std);
};

}  // namespace finray

#endif  // FINRAY_RESIDUALS_PARAMETER_PRIOR_RESIDUAL_H_
