#include "finray/residuals/reference_force_residual.h"

#include <cmath>

namespace finray {

ReferenceForceResidual::ReferenceForceResidual(const FrameEvaluation* frame,
                                               double force_N, double std_N)
    : frame_size_(frame->contacts() > 0 ? frame->frame_size() : 0),
      normal_(frame_size_ > 0 ? frame->contact_offset(0) + 1 : 0),
      per_normal_(frame_size_ > 0 ? std::hypot(1, frame->contact(0).friction)
                                  : 0),
      force_N_(force_N),
      std_N_(std_N) {
  set_num_residuals(1);
  if (frame_size_ > 0) mutable_parameter_block_sizes()->push_back(frame_size_);
  mutable_parameter_block_sizes()->push_back(1);
  mutable_parameter_block_sizes()->push_back(1);
}

bool ReferenceForceResidual::Evaluate(double const* const* parameters,
                                      double* residuals,
                                      double** jacobians) const {
  const int sensor = frame_size_ > 0 ? 1 : 0;  // the block of ln s
  const double scale = std::exp(*parameters[sensor]);
  const double force =
      frame_size_ > 0 ? scale * per_normal_ * parameters[0][normal_] : 0;
  residuals[0] = (force + *parameters[sensor + 1] - force_N_) / std_N_;
  if (jacobians == nullptr) return true;
  if (frame_size_ > 0 && jacobians[0] != nullptr) {
    Eigen::Map<Eigen::VectorXd> by_frame(jacobians[0], frame_size_);
    by_frame.setZero();
    by_frame[normal_] = scale * per_normal_ / std_N_;
  }
  if (double* by_scale = jacobians[sensor]) *by_scale = force / std_N_;
  if (double* by_offset = jacobians[sensor + 1]) *by_offset = 1 / std_N_;
  return true;
}

ReferenceForceVectorResidual::ReferenceForceVectorResidual(
    const FrameEvaluation* frame, const Eigen::Vector2d& force_N, double std_N)
    : FrameResidual(frame, 2, {1, 2}), force_N_(force_N), std_N_(std_N) {}

bool ReferenceForceVectorResidual::Evaluate(double const* const* parameters,
                                            double* residuals,
                                            double** jacobians) const {
  if (!frame().valid()) return false;
  const double scale = std::exp(*parameters[extra_block()]);
  const Eigen::Map<const Eigen::Vector2d> offset(parameters[extra_block() + 1]);
  Eigen::Vector2d sum(0, 0);
  FrameEvaluation::Matrix d_sum =
      FrameEvaluation::Matrix::Zero(2, frame().columns());
  for (int i = 0; i < frame().contacts(); ++i) {
    const PointContact& contact = frame().contact(i);
    const int row = frame().contact_row(i) + 2;
    const double theta = frame().outputs()[row];
    const Eigen::Vector2d t(std::cos(theta), std::sin(theta));
    const Eigen::Vector2d n(t.y(), -t.x());
    const double f = contact.normal_N, mu = contact.friction;
    sum += f * (n + mu * t);
    d_sum += f * (t - mu * n) * frame().d_outputs().row(row);
    d_sum.col(frame().contact_offset(i) + 1) += n + mu * t;
  }
  Eigen::Map<Eigen::Vector2d>(residuals, 2) =
      (scale * sum + offset - force_N_) / std_N_;
  if (jacobians == nullptr) return true;
  for (int i = 0; i < 2; ++i) {
    SpreadRow(i, scale / std_N_ * d_sum.row(i), jacobians);
  }
  if (double* by_scale = jacobians[extra_block()]) {
    Eigen::Map<Eigen::Vector2d>(by_scale, 2) = scale / std_N_ * sum;
  }
  if (double* by_offset = jacobians[extra_block() + 1]) {
    Eigen::Map<Eigen::Matrix2d>(by_offset, 2, 2) =
        Eigen::Matrix2d::Identity() / std_N_;
  }
  return true;
}

}  // namespace finray
