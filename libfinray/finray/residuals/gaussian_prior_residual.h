#ifndef FINRAY_RESIDUALS_GAUSSIAN_PRIOR_RESIDUAL_H_
#define FINRAY_RESIDUALS_GAUSSIAN_PRIOR_RESIDUAL_H_

#include <ceres/cost_function.h>

#include <Eigen/Core>
#include <vector>

namespace finray {

/// What earlier data tell about several parameter blocks together:
///
///   r = R (x - mean),    R'R = information,
///
/// with x the blocks one below the other. ParameterPriorResidual is its simpler
/// sister for one block with independent elements.
class GaussianPriorResidual : public ceres::CostFunction {
 public:
  /// `information` is symmetric and may be singular; `sizes` are those of the
  /// blocks and add up to its rows.
  GaussianPriorResidual(const Eigen::VectorXd& mean,
                        const Eigen::MatrixXd& information,
                        const std::vector<int>& sizes);

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  Eigen::VectorXd mean_;
  Eigen::MatrixXd root_;  // R
};

}  // namespace finray

#endif  // FINRAY_RESIDUALS_GAUSSIAN_PRIOR_RESIDUAL_H_
