#ifndef FINRAY_RESIDUALS_POINT_RESIDUAL_H_
#define FINRAY_RESIDUALS_POINT_RESIDUAL_H_

#include "finray/residuals/frame_residual.h"

namespace finray {

/// A point of the finger that a camera saw at p:
///
///   r = (r_P - (p + o)) / sigma,   two residuals.
///
/// r_P is the point's position in equilibrium, o the origin of the camera's
/// coordinates in frame S (all mm). The point is the tip, or a rib's hinge on
/// the front or back beam. Parameter blocks: those of FrameResidual, camera
/// origin (2, mm).
class PointResidual : public FrameResidual {
 public:
  /// `row` is the pin_row() or tip_row() of `frame`. `at_mm` must stay in
  /// place; it may change between solves.
  PointResidual(const FrameEvaluation* frame, int row,
                const Eigen::Vector2d* at_mm, double std_mm);

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  int row_;  // of x in the frame's outputs
  const Eigen::Vector2d& at_mm_;
  double std_mm_;
};

}  // namespace finray

#endif  // FINRAY_RESIDUALS_POINT_RESIDUAL_H_
