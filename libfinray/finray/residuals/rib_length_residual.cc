#include "finray/residuals/rib_length_residual.h"

namespace finray {

ceres::CostFunction* RibLengthResidual::Create(const FrameEvaluation* frame,
                                               const Finger& finger,
                                               double weight) {
  return new RibLengthResidual(frame, weight / finger.front_length_mm);
}

RibLengthResidual::RibLengthResidual(const FrameEvaluation* frame,
                                     double weight_per_mm)
    : FrameResidual(frame, frame->ribs()), weight_per_mm_(weight_per_mm) {}

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
