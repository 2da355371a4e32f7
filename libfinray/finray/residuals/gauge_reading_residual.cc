#include "finray/residuals/gauge_reading_residual.h"

#include <cmath>

namespace finray {

GaugeReadingResidual::GaugeReadingResidual(
    const FrameEvaluation* frame, int gauge, const double* reading_V,
    double std_V, const std::vector<double>& coefficients)
    : FrameResidual(frame, 1, std::vector<int>(1 + coefficients.size(), 1)),
      gauge_(gauge),
      reading_V_(reading_V),
      std_V_(std_V),
      coefficients_(coefficients) {}

bool GaugeReadingResidual::Evaluate(double const* const* parameters,
                                    double* residuals,
                                    double** jacobians) const {
  if (!frame().valid()) return false;
  const double weight = std::isnan(*reading_V_) ? 0.0 : 1 / std_V_;
  const double gain = *parameters[extra_block()];
  const int first_term = extra_block() + 1;
  const int terms = static_cast<int>(coefficients_.size());
  const double angle = frame().outputs()[gauge_];
  double volts = gain * angle;
  for (int k = 0; k < terms; ++k) {
    volts += coefficients_[k] * *parameters[first_term + k];
  }
  residuals[0] = weight == 0 ? 0 : weight * (volts - *reading_V_);
  if (jacobians == nullptr) return true;
  SpreadRow(0, weight * gain * frame().d_outputs().row(gauge_), jacobians);
  if (double* by_gain = jacobians[extra_block()]) *by_gain = weight * angle;
  for (int k = 0; k < terms; ++k) {
    if (double* by_term = jacobians[first_term + k]) {
      *by_term = weight * coefficients_[k];
    }
  }
  return true;
}

}  // namespace finray
