#include "finray/residuals/parameter_prior_residual.h"

#include <ceres/normal_prior.h>

namespace finray {

ceres::CostFunction* ParameterPriorResidual::Create(
    const Eigen::VectorXd& mean, const Eigen::VectorXd& std) {
  return new ceres::NormalPrior(std.cwiseInverse().asDiagonal(), mean);
}

}  // namespace finray
