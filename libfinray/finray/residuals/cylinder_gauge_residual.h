#ifndef FINRAY_RESIDUALS_CYLINDER_GAUGE_RESIDUAL_H_
#define FINRAY_RESIDUALS_CYLINDER_GAUGE_RESIDUAL_H_

#include <ceres/cost_function.h>

#include <vector>

namespace finray {

/// A gauge's volts on the test bench, where the gauge is bent along its whole
/// length w around a cylinder of radius R:
///
///   r = (gain * (a + q a^2) + sum_k c_k x_k - V) / sigma_V,   a = w / R.
///
/// The sum is that of GaugeReadingResidual. An infinite R means a flat gauge, a
/// negative R bends it the other way. The gauge is read before it creeps.
/// Parameter blocks: gain (1, V/rad), curvature q (1, 1/rad), length w (1, mm),
/// then each x_k (1).
class CylinderGaugeResidual : public ceres::CostFunction {
 public:
  CylinderGaugeResidual(double cylinder_radius_mm, double reading_V,
                        double std_V,
                        const std::vector<double>& coefficients = {1});

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  double cylinder_radius_mm_, reading_V_, std_V_;
  std::vector<double> coefficients_;
};

}  // namespace finray

#endif  // FINRAY_RESIDUALS_CYLINDER_GAUGE_RESIDUAL_H_
