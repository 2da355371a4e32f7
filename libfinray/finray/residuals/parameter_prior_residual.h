#ifndef FINRAY_RESIDUALS_PARAMETER_PRIOR_RESIDUAL_H_
#define FINRAY_RESIDUALS_PARAMETER_PRIOR_RESIDUAL_H_

#include <ceres/normal_prior.h>

#include <Eigen/Core>

namespace finray {

/// Prior knowledge of a parameter block:
///
///   r = (x - mean) / sigma, element by element.
///
/// It is a ceres::NormalPrior with a diagonal matrix. Parameter block: x.
struct ParameterPriorResidual {
  static ceres::CostFunction* Create(const Eigen::VectorXd& mean,
                                     const Eigen::VectorXd& std) {
    return new ceres::NormalPrior(std.cwiseInverse().asDiagonal(), mean);
  }
};

}  // namespace finray

#endif  // FINRAY_RESIDUALS_PARAMETER_PRIOR_RESIDUAL_H_
