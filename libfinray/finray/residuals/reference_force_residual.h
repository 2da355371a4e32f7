#ifndef FINRAY_RESIDUALS_REFERENCE_FORCE_RESIDUAL_H_
#define FINRAY_RESIDUALS_REFERENCE_FORCE_RESIDUAL_H_

#include <ceres/cost_function.h>

#include <array>

#include "finray/residuals/frame_residual.h"
#include "finray/residuals/linear_signal.h"

namespace finray {

/// What a log's force sensor read over time, for a sensor whose readings come
/// late by `time_offset_s`: the force of a row is its own and what the log's
/// force changes by in that time, on a line between its rows.
struct LateForce {
  const LinearSignal* signals = nullptr;  ///< Null: the sensor is not late.
  double time_s = 0;                      ///< of the row
};

/// The magnitude F that a reference force sensor read, for a frame with one
/// contact or none (f_c = 0):
///
///   r = (s f_c sqrt(1 + mu^2) + o - F) / sigma_F.
///
/// s is the sensor's scale and o its offset. The residual is linear in f_c and
/// therefore smooth through zero. Parameter blocks: frame unknowns (if there is
/// a contact), ln s (1), o (1, N), the time offset (1, s) if the sensor may be
/// late, and the effects of FrameResidual if friction is one of them and there
/// is a contact.
class ReferenceForceResidual : public ceres::CostFunction {
 public:
  /// `late` has one signal, the magnitude.
  ReferenceForceResidual(const FrameEvaluation* frame, double force_N,
                         double std_N, const LateForce& late = {});

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  int frame_size_, normal_;  // position of f_c among the frame unknowns
  // The number of effects, if friction is one, and its place among them.
  int effects_, friction_effect_;
  RowFriction row_friction_;
  double friction_, force_N_, std_N_;
  LateForce late_;
};

/// The two components in frame S, F, that a reference force sensor read of the
/// force that the object exerts on the finger, summed over the contacts:
///
///   r = (s R(a) sum_c f_c (n_c + mu t_c) + o + R(b) w - F) / sigma_F,
///
/// two residuals. The sensor's axes are turned by the tilt a. w is the weight
/// of what is mounted on the sensor, as the sensor reads it where the object's
/// angle b is 0; it turns with the object. Parameter blocks: those of
/// FrameResidual, ln s (1), o (2, N), a (1, deg), w (2, N), and the time offset
/// (1, s) if the sensor may be late.
class ReferenceForceVectorResidual : public FrameResidual {
 public:
  /// `late` has two signals, x and y.
  ReferenceForceVectorResidual(const FrameEvaluation* frame,
                               const Eigen::Vector2d& force_N, double std_N,
                               double object_angle_rad = 0,
                               const LateForce& late = {});

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  Eigen::Vector2d force_N_;
  double std_N_, object_angle_rad_;
  LateForce late_;
};

}  // namespace finray

#endif  // FINRAY_RESIDUALS_REFERENCE_FORCE_RESIDUAL_H_
