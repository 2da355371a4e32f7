#ifndef FINRAY_RESIDUALS_EQUILIBRIUM_RESIDUAL_H_
#define FINRAY_RESIDUALS_EQUILIBRIUM_RESIDUAL_H_

#include "finray/residuals/frame_residual.h"

namespace finray {

/// Equilibrium and closure of the tip as soft residuals, for the weighted form:
///
///   r = w S (x_F - x_B, y_F - y_B, theta_F - theta_B - cap angle,
///            M_F + M_B, N_F + N_B),   six residuals.
///
/// S is diagonal and scales lengths by 1 / l_0, moments by l_0 / EI and forces
/// by l_0^2 / EI. A weight w of at least 1e6 holds equilibrium to below gauge
/// noise; docs/reference/calibration.md says what it does to normal equations.
/// Parameter blocks: those of FrameResidual.
class EquilibriumResidual : public FrameResidual {
 public:
  EquilibriumResidual(const FrameEvaluation* frame, const Finger& finger,
                      double weight);

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  Eigen::Matrix<double, 6, 1> weight_;
};

}  // namespace finray

#endif  // FINRAY_RESIDUALS_EQUILIBRIUM_RESIDUAL_H_
