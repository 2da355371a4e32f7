#include "finray/residuals/cylinder_gauge_residual.h"

#include <cmath>

#include "finray/finger/finger.h"

namespace finray {

CylinderGaugeResidual::CylinderGaugeResidual(
    double cylinder_radius_mm, double reading_V, double std_V,
    const std::vector<double>& coefficients, bool flat)
    : cylinder_radius_mm_(cylinder_radius_mm),
      reading_V_(reading_V),
      std_V_(std_V),
      coefficients_(coefficients),
      flat_(flat) {
  set_num_residuals(1);
  mutable_parameter_block_sizes()->assign(First() + coefficients.size(), 1);
}

bool CylinderGaugeResidual::Evaluate(double const* const* parameters,
                                     double* residuals,
                                     double** jacobians) const {
  const double gain = *parameters[0], curvature = *parameters[1];
  const double angle = *parameters[2] / cylinder_radius_mm_;
  Gauge gauge;
  gauge.gain_V_per_rad = gain;
  gauge.curvature_per_rad = curvature;
  if (flat_) {
    gauge.flat_share = *parameters[3];
    gauge.flat_width_rad = std::exp(*parameters[4]);
  }
  const double bent = gauge.Signal(angle);
  double volts = gain * bent;
  for (std::size_t k = 0; k < coefficients_.size(); ++k) {
    volts += coefficients_[k] * *parameters[First() + k];
  }
  residuals[0] = (volts - reading_V_) / std_V_;
  if (jacobians == nullptr) return true;
  const auto set = [&](std::size_t block, double value) {
    if (jacobians[block] != nullptr) *jacobians[block] = value / std_V_;
  };
  set(0, bent);
  set(1, gain * angle * angle);
  set(2, gauge.Slope(angle) / cylinder_radius_mm_);
  if (flat_) {
    set(3, gain * gauge.SignalByFlatShare(angle));
    set(4, gain * gauge.flat_width_rad * gauge.SignalByFlatWidth(angle));
  }
  for (std::size_t k = 0; k < coefficients_.size(); ++k) {
    set(First() + k, coefficients_[k]);
  }
  return true;
}

}  // namespace finray
