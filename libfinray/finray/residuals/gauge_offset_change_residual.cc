#include "finray/residuals/gauge_offset_change_residual.h"

#include <cmath>

namespace finray {

GaugeOffsetChangeResidual::GaugeOffsetChangeResidual(double std_V_per_sqrt_s,
                                                     double dt_s)
    : weight_(1 / (std_V_per_sqrt_s * std::sqrt(dt_s))) {}

bool GaugeOffsetChangeResidual::Evaluate(double const* const* parameters,
                                         double* residuals,
                                         double** jacobians) const {
  residuals[0] = weight_ * (*parameters[1] - *parameters[0]);
  if (jacobians == nullptr) return true;
  if (jacobians[0] != nullptr) *jacobians[0] = -weight_;
  if (jacobians[1] != nullptr) *jacobians[1] = weight_;
  return true;
}

}  // namespace finray
