#include "finray/control/object_filter.h"

#include <Eigen/LU>

namespace finray {
namespace {

constexpr double kStartVelocityStd_mm_s = 3;

}  // namespace

ObjectFilter::ObjectFilter(const ObjectPrior& prior, double period_s)
    : prior_(prior), period_s_(period_s) {
  covariance_(2, 2) = prior.compliance_mm_per_N * prior.compliance_mm_per_N;
}

void ObjectFilter::Predict() {
  if (!started_) return;
  const double T = period_s_;
  Eigen::Matrix3d step = Eigen::Matrix3d::Identity();
  step(0, 1) = T;
  x_ = step * x_;
  const Eigen::Vector3d push =
      prior_.acceleration_mm_s2 * Eigen::Vector3d(0.5 * T * T, T, 0);
  covariance_ = step * covariance_ * step.transpose() + push * push.transpose();
}

void ObjectFilter::Update(double place_mm, double force_N, double std_mm) {
  const double variance = std_mm * std_mm;
  if (!started_) {
    // The first place, with the compliance known so far.
    const double compliance_variance = covariance_(2, 2);
    covariance_.setZero();
    covariance_(0, 0) = variance + force_N * force_N * compliance_variance;
    covariance_(0, 2) = covariance_(2, 0) = force_N * compliance_variance;
    covariance_(1, 1) = kStartVelocityStd_mm_s * kStartVelocityStd_mm_s;
    covariance_(2, 2) = compliance_variance;
    x_ = {place_mm + x_[2] * force_N, 0, x_[2]};
    started_ = true;
    return;
  }
  const Eigen::RowVector3d h(1, 0, -force_N);
  const Eigen::Vector3d gain = covariance_ * h.transpose() /
                               (h * covariance_ * h.transpose() + variance);
  x_ += gain * (place_mm - h * x_);
  covariance_ -= gain * (h * covariance_);
  covariance_ = (0.5 * (covariance_ + covariance_.transpose())).eval();
  if (x_[2] < 0) {
    // The most likely state with no compliance.
    x_ -= covariance_.col(2) * (x_[2] / covariance_(2, 2));
    x_[2] = 0;
  }
}

}  // namespace finray
