#ifndef FINRAY_RESIDUALS_GAUGE_READING_RESIDUAL_H_
#define FINRAY_RESIDUALS_GAUGE_READING_RESIDUAL_H_

#include <vector>

#include "finray/residuals/creep_history.h"
#include "finray/residuals/frame_residual.h"

namespace finray {

/// A gauge's reading against its bending angle, equation (16):
///
///   r = (gain * (alpha_j + q alpha_j^2) + sum_k c_k x_k - V) / sigma_V,
///   alpha_j = theta(p_j + w_j) - theta(p_j).
///
/// The sum holds everything in a reading that does not come from bending. Its
/// first term is the offset, x_1 with c_1 = 1. A calibration may add a drift
/// rate times the time, and a temperature coefficient times the difference to
/// the reference temperature. Of a gauge that creeps, V counts without its
/// lagging part, V - share (F - x_1 / (1 + share)) (CreepHistory). Parameter
/// blocks: those of FrameResidual, gain (1, V/rad), curvature q (1, 1/rad), p_j
/// and w_j if the frame's gauges are movable (1 each, mm), share and ln of the
/// time constant if the gauge creeps (1 each), then each x_k (1). A NaN reading
/// (not measured) gives a zero residual.
class GaugeReadingResidual : public FrameResidual {
 public:
  /// `reading_V` must stay in place; its value may change between solves.
  /// `coefficients` are the c_k; the default is an offset only.
  GaugeReadingResidual(const FrameEvaluation* frame, int gauge,
                       const double* reading_V, double std_V,
                       const std::vector<double>& coefficients = {1},
                       const CreepTerm& creep = {});

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  int gauge_;
  const double* reading_V_;
  double std_V_;
  std::vector<double> coefficients_;
  const CreepHistory* creep_;
  int creep_row_;
};

}  // namespace finray

#endif  // FINRAY_RESIDUALS_GAUGE_READING_RESIDUAL_H_
