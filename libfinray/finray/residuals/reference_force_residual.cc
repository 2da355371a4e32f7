#include "finray/residuals/reference_force_residual.h"

#include <Eigen/Geometry>
#include <cmath>
#include <vector>

namespace finray {

ReferenceForceResidual::ReferenceForceResidual(const FrameEvaluation* frame,
                                               double force_N, double std_N,
                                               const LateForce& late)
    : frame_size_(frame->contacts() > 0 ? frame->frame_size() : 0),
      normal_(frame_size_ > 0 ? frame->contact_offset(0) + 1 : 0),
      effects_(0),
      friction_effect_(frame_size_ > 0 ? frame->friction_effect() : -1),
      row_friction_(frame->row_friction()),
      friction_(frame_size_ > 0 ? frame->contact(0).friction : 0),
      force_N_(force_N),
      std_N_(std_N),
      late_(late) {
  set_num_residuals(1);
  if (frame_size_ > 0) mutable_parameter_block_sizes()->push_back(frame_size_);
  mutable_parameter_block_sizes()->push_back(1);
  mutable_parameter_block_sizes()->push_back(1);
  if (late_.signals != nullptr) mutable_parameter_block_sizes()->push_back(1);
  if (friction_effect_ >= 0) {
    effects_ = frame->effects();
    mutable_parameter_block_sizes()->push_back(effects_);
  }
}

bool ReferenceForceResidual::Evaluate(double const* const* parameters,
                                      double* residuals,
                                      double** jacobians) const {
  const int sensor = frame_size_ > 0 ? 1 : 0;  // the block of ln s
  const double scale = std::exp(*parameters[sensor]);
  const int effects = sensor + (late_.signals != nullptr ? 3 : 2);
  const double friction =
      effects_ > 0 ? row_friction_.At(parameters[effects][friction_effect_])
                   : friction_;
  const double per_normal = std::hypot(1, friction);
  const double force =
      frame_size_ > 0 ? scale * per_normal * parameters[0][normal_] : 0;
  LinearSignal::Point read{force_N_, 0};
  if (late_.signals != nullptr) {
    read = late_.signals[0].Change(late_.time_s, *parameters[sensor + 2]);
    read.value += force_N_;
  }
  residuals[0] = (force + *parameters[sensor + 1] - read.value) / std_N_;
  if (jacobians == nullptr) return true;
  if (frame_size_ > 0 && jacobians[0] != nullptr) {
    Eigen::Map<Eigen::VectorXd> by_frame(jacobians[0], frame_size_);
    by_frame.setZero();
    by_frame[normal_] = scale * per_normal / std_N_;
  }
  if (double* by_scale = jacobians[sensor]) *by_scale = force / std_N_;
  if (double* by_offset = jacobians[sensor + 1]) *by_offset = 1 / std_N_;
  if (late_.signals != nullptr && jacobians[sensor + 2] != nullptr) {
    *jacobians[sensor + 2] = -read.slope / std_N_;
  }
  if (effects_ > 0 && jacobians[effects] != nullptr) {
    Eigen::Map<Eigen::VectorXd> by_effect(jacobians[effects], effects_);
    by_effect.setZero();
    by_effect[friction_effect_] = row_friction_.slope * force * friction /
                                  (per_normal * per_normal) / std_N_;
  }
  return true;
}

ReferenceForceVectorResidual::ReferenceForceVectorResidual(
    const FrameEvaluation* frame, const Eigen::Vector2d& force_N, double std_N,
    double object_angle_rad, const LateForce& late)
    : FrameResidual(frame, 2, {1, 2, 1, 2}),
      force_N_(force_N),
      std_N_(std_N),
      object_angle_rad_(object_angle_rad),
      late_(late) {
  if (late_.signals != nullptr) mutable_parameter_block_sizes()->push_back(1);
}

bool ReferenceForceVectorResidual::Evaluate(double const* const* parameters,
                                            double* residuals,
                                            double** jacobians) const {
  if (!frame().valid()) return false;
  double const* const* const own = parameters + extra_block();
  const double scale = std::exp(*own[0]);
  const Eigen::Map<const Eigen::Vector2d> offset(own[1]), weight(own[3]);
  const Eigen::Matrix2d tilt =
      Eigen::Rotation2Dd(*own[2] * M_PI / 180).toRotationMatrix();
  const Eigen::Matrix2d turn =
      Eigen::Rotation2Dd(object_angle_rad_).toRotationMatrix();
  Eigen::Vector2d read = force_N_, read_slope(0, 0);
  for (int i = 0; late_.signals != nullptr && i < 2; ++i) {
    const auto change = late_.signals[i].Change(late_.time_s, *own[4]);
    read[i] += change.value;
    read_slope[i] = change.slope;
  }
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
    if (frame().friction_effect() >= 0) {
      d_sum.col(frame().effect_column() + frame().friction_effect()) +=
          frame().row_friction().slope * f * t;
    }
  }
  Eigen::Map<Eigen::Vector2d>(residuals, 2) =
      (scale * tilt * sum + offset + turn * weight - read) / std_N_;
  if (jacobians == nullptr) return true;
  for (int i = 0; i < 2; ++i) {
    SpreadRow(i, scale / std_N_ * tilt.row(i) * d_sum, jacobians);
  }
  using RowMajor = Eigen::Matrix<double, 2, 2, Eigen::RowMajor>;
  const Eigen::Vector2d force = scale * tilt * sum;
  double** const by = jacobians + extra_block();
  const auto set = [&](int block, const Eigen::Vector2d& column) {
    if (by[block] == nullptr) return;
    Eigen::Map<Eigen::Vector2d>(by[block], 2) = column / std_N_;
  };
  set(0, force);
  if (by[1] != nullptr) {
    Eigen::Map<RowMajor>(by[1], 2, 2) = RowMajor::Identity() / std_N_;
  }
  set(2, M_PI / 180 * Eigen::Vector2d(-force.y(), force.x()));
  if (by[3] != nullptr) Eigen::Map<RowMajor>(by[3], 2, 2) = turn / std_N_;
  if (late_.signals != nullptr) set(4, -read_slope);
  return true;
}

}  // namespace finray
