#include "finray/residuals/cylinder_gauge_residual.h"

namespace finray {

CylinderGaugeResidual::CylinderGaugeResidual(
    double cylinder_radius_mm, double reading_V, double std_V,
    const std::vector<double>& coefficients)
    : cylinder_radius_mm_(cylinder_radius_mm),
      reading_V_(reading_V),
      std_V_(std_V),
      coefficients_(coefficients) {
  set_num_residuals(1);
  mutable_parameter_block_sizes()->assign(3 + coefficients.size(), 1);
}

bool CylinderGaugeResidual::Evaluate(double const* const* parameters,
                                     double* residuals,
                                     double** jacobians) const {
  const double gain = *parameters[0], curvature = *parameters[1];
  const double angle = *parameters[2] / cylinder_radius_mm_;
  const double bent = angle * (1 + curvature * angle);
  double volts = gain * bent;
  for (std::size_t k = 0; k < coefficients_.size(); ++k) {
    volts += coefficients_[k] * *parameters[3 + k];
  }
  residuals[0] = (volts - reading_V_) / std_V_;
  if (jacobians == nullptr) return true;
  const auto set = [&](std::size_t block, double value) {
    if (jacobians[block] != nullptr) *jacobians[block] = value / std_V_;
  };
  set(0, bent);
  set(1, gain * angle * angle);
  set(2, gain * (1 + 2 * curvature * angle) / cylinder_radius_mm_);
  for (std::size_t k = 0; k < coefficients_.size(); ++k) {
    set(3 + k, coefficients_[k]);
  }
  return true;
}

}  // namespace finray
