#include "finray/residuals/contact_change_residual.h"

namespace finray {

bool ContactChangeResidual::Evaluate(double const* const* parameters,
                                     double* residuals,
                                     double** jacobians) const {
  for (int i = 0; i < 2; ++i) {
    residuals[i] = weight_[i] * (parameters[1][i] - parameters[0][i]);
    if (jacobians == nullptr) continue;
    for (int block = 0; block < 2; ++block) {
      if (jacobians[block] == nullptr) continue;
      // 2 x 2, row by row.
      jacobians[block][2 * i + i] = block == 0 ? -weight_[i] : weight_[i];
      jacobians[block][2 * i + 1 - i] = 0;
    }
  }
  return true;
}

}  // namespace finray
