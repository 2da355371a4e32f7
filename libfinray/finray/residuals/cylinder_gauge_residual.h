#ifndef FINRAY_RESIDUALS_CYLINDER_GAUGE_RESIDUAL_H_
#define FINRAY_RESIDUALS_CYLINDER_GAUGE_RESIDUAL_H_

#include <ceres/cost_function.h>

#include <vector>

namespace finray {

/// A gauge's volts on the test bench, where the gauge is bent along its whole
/// length w around a cylinder of radius R:
///
///   r = (gain * s(a) + sum_k c_k x_k - V) / sigma_V,   a = w / R.
///
/// Signal and sum are those of GaugeReadingResidual. An infinite R means a flat
/// gauge, a negative R bends it the other way. The gauge is read before it
/// creeps, and without hysteresis. Parameter blocks: gain (1, V/rad), curvature
/// (1, 1/rad), length w (1, mm), share and ln of the width if the gauge may be
/// flat (1 each), then each x_k (1).
class CylinderGaugeResidual : public ceres::CostFunction {
 public:
  CylinderGaugeResidual(double cylinder_radius_mm, double reading_V,
                        double std_V,
                        const std::vector<double>& coefficients = {1},
                        bool flat = false);

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  // The block of the first term.
  std::size_t First() const { return flat_ ? 5 : 3; }

  double cylinder_radius_mm_, reading_V_, std_V_;
  std::vector<double> coefficients_;
  bool flat_;
};

}  // namespace finray

#endif  // FINRAY_RESIDUALS_CYLINDER_GAUGE_RESIDUAL_H_
