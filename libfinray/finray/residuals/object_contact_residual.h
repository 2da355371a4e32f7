#ifndef FINRAY_RESIDUALS_OBJECT_CONTACT_RESIDUAL_H_
#define FINRAY_RESIDUALS_OBJECT_CONTACT_RESIDUAL_H_

#include "finray/residuals/frame_residual.h"

namespace finray {

/// Tangency of the front beam to a circular object whose centre was measured:
///
///   r = (r_c - R n_c - p_S) / sigma,   two residuals.
///
/// r_c is the contact point, n_c the local normal into the finger, R the
/// circle's radius and p_S the measured centre p in frame S (StageFrame; all
/// mm). The component of r along the tangent determines l_c, the one along the
/// normal the indentation. A NaN coordinate (not measured) gives a zero
/// residual; it counts as 0 where the other coordinate is turned. Parameter
/// blocks: those of FrameResidual, object origin (2, mm), rotation (1, deg),
/// ln of the scale (1), radius (1, mm).
class ObjectContactResidual : public FrameResidual {
 public:
  /// `center_mm` must stay in place; it may change between solves.
  ObjectContactResidual(const FrameEvaluation* frame, int contact,
                        const Eigen::Vector2d* center_mm, double std_mm);

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  int contact_;
  const Eigen::Vector2d& center_mm_;
  double std_mm_;
};

/// A measured contact location l:
///
///   r = (l_c - l) / sigma.
///
/// Parameter block: frame unknowns.
class ContactLocationResidual : public ceres::CostFunction {
 public:
  ContactLocationResidual(const FrameEvaluation* frame, int contact,
                          double arc_mm, double std_mm);

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  int position_;  // of l_c among the frame unknowns
  double arc_mm_, std_mm_;
};

}  // namespace finray

#endif  // FINRAY_RESIDUALS_OBJECT_CONTACT_RESIDUAL_H_
