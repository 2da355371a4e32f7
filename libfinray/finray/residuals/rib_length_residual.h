#ifndef FINRAY_RESIDUALS_RIB_LENGTH_RESIDUAL_H_
#define FINRAY_RESIDUALS_RIB_LENGTH_RESIDUAL_H_

#include "finray/residuals/frame_residual.h"

namespace finray {

/// The rib lengths, equation (7), as soft residuals for the weighted form:
///
///   r_k = w (|r_Rk - r_Lk| - L_k (1 + T_k / EA_k) + b_k) / l_0,   k = 1 .. r.
///
/// r_Lk and r_Rk are the ends of rib k on the two beams, L_k its length, T_k
/// its tension, EA_k its axial stiffness and b_k what bending shortens it by
/// (ladder/rib_law.h; 0 on hinges). Parameter blocks: those of FrameResidual.
class RibLengthResidual : public FrameResidual {
 public:
  RibLengthResidual(const FrameEvaluation* frame, const Finger& finger,
                    double weight);

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  double weight_per_mm_;
};

}  // namespace finray

#endif  // FINRAY_RESIDUALS_RIB_LENGTH_RESIDUAL_H_
