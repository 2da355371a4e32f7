#ifndef FINRAY_RESIDUALS_GAUGE_READING_RESIDUAL_H_
#define FINRAY_RESIDUALS_GAUGE_READING_RESIDUAL_H_

#include <vector>

#include "finray/residuals/frame_residual.h"
#include "finray/residuals/reading_history.h"
#include "finray/scene/measurements.h"

namespace finray {

/// A gauge's reading against its bending angle, equation (16):
///
///   r = (gain * s(alpha_j) + sum_k c_k x_k - V) / sigma_V,
///   alpha_j = theta(p_j + w_j) - theta(p_j),
///
/// with the signal s of Gauge.
///
/// The sum holds everything in a reading that does not come from bending. Its
/// first term is the offset, x_1 with c_1 = 1. A calibration may add a drift
/// rate times the time, and a temperature coefficient times the difference to
/// the reference temperature. Of a gauge with a history, V counts without its
/// lagging part and where it would be without hysteresis, V - share (F - x_1 /
/// (1 + share)) + d (ReadingHistory). Parameter
/// blocks: those of FrameResidual, gain (1, V/rad), curvature (1, 1/rad), the
/// share and ln of the width if the gauge may be flat (1 each), p_j and w_j if
/// the frame's gauges are movable (1 each, mm), share and ln of the time
/// constant of creep and the hysteresis in rad if there is a history (1 each),
/// then each x_k (1). A NaN reading
/// (not measured) gives a zero residual.
class GaugeReadingResidual : public FrameResidual {
 public:
  /// `row` must stay in place; its numbers may change between solves. sigma_V
  /// is that of the row's reading where one of the gauge has `noise_V`.
  /// `coefficients` are the c_k; the default is an offset only.
  GaugeReadingResidual(const FrameEvaluation* frame, int gauge,
                       const Measurements* row, double noise_V,
                       std::vector<double> coefficients = {1},
                       const HistoryTerm& history = {}, bool flat = false);

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;
  /// sigma_V
  double std_V() const;

 private:
  int gauge_;
  const Measurements& row_;
  double noise_V_, kept_std_V_;
  std::vector<double> coefficients_;
  const ReadingHistory* history_;
  int history_row_;
  bool flat_;
};

}  // namespace finray

#endif  // FINRAY_RESIDUALS_GAUGE_READING_RESIDUAL_H_
