#include "finray/residuals/reference_force_residual.h"

#include <cmath>

namespace finray {

ceres::CostFunction* ReferenceForceResidual::Create(
    const FrameEvaluation* frame, double force_N, double std_N) {
  return new ReferenceForceResidual(frame, force_N, std_N);
}

ReferenceForceResidual::ReferenceForceResidual(const FrameEvaluation* frame,
                                               double force_N, double std_N)
    : frame_size_(frame->frame_size()),
      normal_(frame->contact_offset(0) + 1),
      per_normal_(std::hypot(1, frame->contact(0).friction)),
      force_N_(force_N),
      std_N_(std_N) {
  set_num_residuals(1);
  mutable_parameter_block_sizes()->push_back(frame_size_);
}

bool ReferenceForceResidual::Evaluate(double const* const* parameters,
                                      double* residuals,
                                      double** jacobians) const {
  residuals[0] = (per_normal_ * parameters[0][normal_] - force_N_) / std_N_;
  if (jacobians != nullptr && jacobians[0] != nullptr) {
    Eigen::Map<Eigen::VectorXd> by_frame(jacobians[0], frame_size_);
    by_frame.setZero();
    by_frame[normal_] = per_normal_ / std_N_;
  }
  return true;
}

ceres::CostFunction* ReferenceForceVectorResidual::Create(
    const FrameEvaluation* frame, const Eigen::Vector2d& force_N,
    double std_N) {
  return new ReferenceForceVectorResidual(frame, force_N, std_N);
}

ReferenceForceVectorResidual::ReferenceForceVectorResidual(
    const FrameEvaluation* frame, const Eigen::Vector2d& force_N, double std_N)
    : FrameResidual(frame, 2), force_N_(force_N), std_N_(std_N) {}

bool ReferenceForceVectorResidual::Evaluate(double const* const* /*parameters*/,
                                            double* residuals,
                                            double** jacobians) const {
  if (!frame().valid()) return false;
  Eigen::Vector2d sum = -force_N_;
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
  Eigen::Map<Eigen::Vector2d>(residuals, 2) = sum / std_N_;
  if (jacobians != nullptr) {
    for (int i = 0; i < 2; ++i) SpreadRow(i, d_sum.row(i) / std_N_, jacobians);
  }
  return true;
}

}  // namespace finray
