#ifndef FINRAY_RESIDUALS_REFERENCE_FORCE_RESIDUAL_H_
#define FINRAY_RESIDUALS_REFERENCE_FORCE_RESIDUAL_H_

#include <ceres/cost_function.h>

#include "finray/residuals/frame_residual.h"

namespace finray {

/// The magnitude F that a reference force sensor read, for a frame with one
/// contact or none (f_c = 0):
///
///   r = (s f_c sqrt(1 + mu^2) + o - F) / sigma_F.
///
/// s is the sensor's scale and o its offset. The residual is linear in f_c and
/// therefore smooth through zero. Parameter blocks: frame unknowns (if there is
/// a contact), ln s (1), o (1, N).
class ReferenceForceResidual : public ceres::CostFunction {
 public:
  ReferenceForceResidual(const FrameEvaluation* frame, double force_N,
                         double std_N);

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  int frame_size_, normal_;  // position of f_c among the frame unknowns
  double per_normal_, force_N_, std_N_;
};

/// The two components in frame S, F, that a reference force sensor read of the
/// force that the object exerts on the finger, summed over the contacts:
///
///   r = (s sum_c f_c (n_c + mu t_c) + o - F) / sigma_F,   two residuals.
///
/// Parameter blocks: those of FrameResidual, ln s (1), o (2, N).
class ReferenceForceVectorResidual : public FrameResidual {
 public:
  ReferenceForceVectorResidual(const FrameEvaluation* frame,
                               const Eigen::Vector2d& force_N, double std_N);

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  Eigen::Vector2d force_N_;
  double std_N_;
};

}  // namespace finray

#endif  // FINRAY_RESIDUALS_REFERENCE_FORCE_RESIDUAL_H_
