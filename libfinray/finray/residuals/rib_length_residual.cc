#include "finray/residuals/rib_length_residual.h"

namespace finray {

RibLengthResidual::RibLengthResidual(const FrameEvaluation* frame,
                                     const Finger& finger, double weight)
    : FrameResidual(frame, frame->ribs()),
      weight_per_mm_(weight / finger.front_length_mm) {}

bool RibLengthResidual::Evaluate(double const* const* /*parameters*/,
                                 double* residuals, double** jacobians) const {
  if (!frame().valid()) return false;
  for (int i = 0; i < frame().ribs(); ++i) {
    residuals[i] = weight_per_mm_ * frame().closure()[i];
    if (jacobians != nullptr) {
      SpreadRow(i, weight_per_mm_ * frame().d_closure().row(i), jacobians);
    }
  }
  return true;
}

}  // namespace finray
