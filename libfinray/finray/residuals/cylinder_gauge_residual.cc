#include "finray/residuals/cylinder_gauge_residual.h"

namespace finray {

CylinderGaugeResidual::CylinderGaugeResidual(
    double gauge_length_mm, double cylinder_radius_mm, double reading_V,
    double std_V, const std::vector<double>& coefficients)
    : angle_rad_(gauge_length_mm / cylinder_radius_mm),
      reading_V_(reading_V),
      std_V_(std_V),
      coefficients_(coefficients) {
  set_num_residuals(1);
  mutable_parameter_block_sizes()->assign(1 + coefficients.size(), 1);
}

bool CylinderGaugeResidual::Evaluate(double const* const* parameters,
                                     double* residuals,
                                     double** jacobians) const {
  double volts = *parameters[0] * angle_rad_;
  for (std::size_t k = 0; k < coefficients_.size(); ++k) {
    volts += coefficients_[k] * *parameters[1 + k];
  }
  residuals[0] = (volts - reading_V_) / std_V_;
  if (jacobians == nullptr) return true;
  if (jacobians[0] != nullptr) *jacobians[0] = angle_rad_ / std_V_;
  for (std::size_t k = 0; k < coefficients_.size(); ++k) {
    if (jacobians[1 + k] != nullptr) {
      *jacobians[1 + k] = coefficients_[k] / std_V_;
    }
  }
  return true;
}

}  // namespace finray
