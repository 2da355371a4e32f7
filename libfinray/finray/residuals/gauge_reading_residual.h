#ifndef FINRAY_RESIDUALS_GAUGE_READING_RESIDUAL_H_
#define FINRAY_RESIDUALS_GAUGE_READING_RESIDUAL_H_

#include "finray/residuals/frame_residual.h"

namespace finray {

/// A gauge's volts against its bending angle (16):
///
///   r = (gain * alpha_j + offset - V) / sigma_V,
///   alpha_j = theta(p_j + w_j) - theta(p_j).
///
/// Parameter blocks: those of FrameResidual, gain (1, V/rad), offset (1, V).
/// A NaN reading (not measured) gives a zero residual.
class GaugeReadingResidual : public FrameResidual {
 public:
  /// `reading_V` must stay in place; it may change between solves.
  static ceres::CostFunction* Create(const FrameEvaluation* frame, int gauge,
                                     const double* reading_V, double std_V);

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  GaugeReadingResidual(const FrameEvaluation* frame, int gauge,
                       const double* reading_V, double std_V);

  int gauge_;
  const double* reading_V_;
  double std_V_;
};

}  // namespace finray

#endif  // FINRAY_RESIDUALS_GAUGE_READING_RESIDUAL_H_
