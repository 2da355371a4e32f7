#ifndef FINRAY_RESIDUALS_GAUGE_OFFSET_CHANGE_RESIDUAL_H_
#define FINRAY_RESIDUALS_GAUGE_OFFSET_CHANGE_RESIDUAL_H_

#include <ceres/sized_cost_function.h>

namespace finray {

/// A gauge's offset b wanders from one frame to the next, dt later:
///
///   r = (b_{t+1} - b_t) / (q sqrt(dt)),
///
/// a random walk whose std grows by q V in the square root of a second.
/// Parameter blocks: b_t (1, V), b_{t+1} (1, V).
class GaugeOffsetChangeResidual : public ceres::SizedCostFunction<1, 1, 1> {
 public:
  /// `std_V_per_sqrt_s` is q; both must be above 0.
  GaugeOffsetChangeResidual(double std_V_per_sqrt_s, double dt_s);

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  double weight_;  // 1 / V
};

}  // namespace finray

#endif  // FINRAY_RESIDUALS_GAUGE_OFFSET_CHANGE_RESIDUAL_H_
