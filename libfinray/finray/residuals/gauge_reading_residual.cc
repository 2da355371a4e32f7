#include "finray/residuals/gauge_reading_residual.h"

#include <cmath>

namespace finray {

ceres::CostFunction* GaugeReadingResidual::Create(const FrameEvaluation* frame,
                                                  int gauge,
                                                  const double* reading_V,
                                                  double std_V) {
  return new GaugeReadingResidual(frame, gauge, reading_V, std_V);
}

GaugeReadingResidual::GaugeReadingResidual(const FrameEvaluation* frame,
                                           int gauge, const double* reading_V,
                                           double std_V)
    : FrameResidual(frame, 1, {1, 1}),
      gauge_(gauge),
      reading_V_(reading_V),
      std_V_(std_V) {}

bool GaugeReadingResidual::Evaluate(double const* const* parameters,
                                    double* residuals,
                                    double** jacobians) const {
  if (!frame().valid()) return false;
  const double weight = std::isnan(*reading_V_) ? 0.0 : 1 / std_V_;
  const double gain = *parameters[extra_block()];
  const double offset = *parameters[extra_block() + 1];
  const double angle = frame().outputs()[gauge_];
  residuals[0] =
      weight == 0 ? 0 : weight * (gain * angle + offset - *reading_V_);
  if (jacobians == nullptr) return true;
  SpreadRow(0, weight * gain * frame().d_outputs().row(gauge_), jacobians);
  if (double* by_gain = jacobians[extra_block()]) *by_gain = weight * angle;
  if (double* by_offset = jacobians[extra_block() + 1]) *by_offset = weight;
  return true;
}

}  // namespace finray
