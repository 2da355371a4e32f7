#include "finray/residuals/equilibrium_residual.h"

#include "finray/finger/geometry.h"

namespace finray {

EquilibriumResidual::EquilibriumResidual(const FrameEvaluation* frame,
                                         const Finger& finger, double weight)
    : FrameResidual(frame, 6) {
  const double length = finger.front_length_mm;
  const double force = ForceUnit(finger);
  weight_ << 1 / length, 1 / length, 1, 1 / (force * length), 1 / force,
      1 / force;
  weight_ *= weight;
}

bool EquilibriumResidual::Evaluate(double const* const* /*parameters*/,
                                   double* residuals,
                                   double** jacobians) const {
  if (!frame().valid()) return false;
  const int first = frame().ribs();
  for (int i = 0; i < 6; ++i) {
    residuals[i] = weight_[i] * frame().closure()[first + i];
    if (jacobians != nullptr) {
      SpreadRow(i, weight_[i] * frame().d_closure().row(first + i), jacobians);
    }
  }
  return true;
}

}  // namespace finray
