#include "finray/control/model_controller.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace finray {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int kMostIterations = 30;
constexpr double kGapTolerance_mm = 1e-7;
constexpr double kLongestStep_mm = 10;
constexpr double kEnd_mm = 0.5;  // least distance of a contact from the ends

constexpr double kStartVelocityStd_mm_s = 3;

// The height is a mean of so many estimates. Older ones fade, because the
// object may slide along the finger.
constexpr int kHeightMemory = 30;
constexpr int kMostDriveSteps = 20;
constexpr double kTolerance_mm = 1e-6;
// Lower limit of the std of a force.
constexpr double kLeastStd_N = 1e-4;

}  // namespace

PushModel::PushModel(const Finger& finger, double radius_mm, double friction,
                     const Discretization& discretization)
    : solver_(finger, discretization),
      radius_mm_(radius_mm),
      friction_(friction) {}

std::optional<Vector2d> PushModel::Centre(const Pose<double>& base,
                                          double arc_mm, double normal_N) {
  if (!solver_.SolveWithSensitivities({{arc_mm, normal_N, friction_}})) {
    return std::nullopt;
  }
  const Vector3d pose = solver_.contact_pose(0);
  const Vector2d tangent(std::cos(pose.z()), std::sin(pose.z()));
  const Vector2d normal = -Turned<double>(tangent);
  const int row = solver_.model().gauges();
  const auto derivative = [&](int column) {
    const Vector3d d = solver_.d_outputs().block<3, 1>(row, column);
    // dn/dtheta = t.
    return base.Rotate(d.head<2>() - radius_mm_ * d.z() * tangent);
  };
  by_arc_ = derivative(0);
  by_force_ = derivative(1);
  return base * Vector2d(pose.head<2>() - radius_mm_ * normal);
}

std::optional<Push> PushModel::At(const Pose<double>& base, double y_mm,
                                  double normal_N, double arc_mm) {
  const double end = solver_.model().finger().front_length_mm - kEnd_mm;
  arc_mm = std::clamp(arc_mm, kEnd_mm, end);
  for (int i = 0; i < kMostIterations; ++i) {
    const auto centre = Centre(base, arc_mm, normal_N);
    if (!centre) return std::nullopt;
    const double gap = y_mm - centre->y();
    const double step = gap / by_arc_.y();
    if (std::abs(gap) < kGapTolerance_mm) {
      const double compliance =
          by_force_.x() - by_arc_.x() * by_force_.y() / by_arc_.y();
      return Push{centre->x(), arc_mm, 1 / compliance};
    }
    const double next =
        std::clamp(arc_mm + std::clamp(step, -kLongestStep_mm, kLongestStep_mm),
                   kEnd_mm, end);
    if (!std::isfinite(step) || next == arc_mm) return std::nullopt;
    arc_mm = next;
  }
  return std::nullopt;
}

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

ModelController::ModelController(std::vector<PushModel> models,
                                 const Mechanism& mechanism,
                                 const ObjectPrior& prior, double period_s,
                                 bool preview)
    : models_(std::move(models)),
      mechanism_(mechanism),
      filter_(prior, period_s),
      period_s_(period_s),
      timing_std_s_(prior.timing_std_s),
      preview_(preview),
      y_mm_(models_.size(), 0),
      arc_mm_(models_.size(), 0) {}

void ModelController::Lost() {
  filter_.Restart();
  seen_ = 0;
  last_drive_.reset();
}

bool ModelController::SeeHeights(double drive,
                                 const std::vector<ContactEstimate>& contacts) {
  const auto base = mechanism_.FingerPose(drive);
  if (!base) return false;
  std::vector<double> heights;
  for (std::size_t i = 0; i < models_.size(); ++i) {
    const auto centre =
        models_[i].Centre(*base, contacts[i].arc_mm, contacts[i].normal_N);
    if (!centre) return false;
    heights.push_back(centre->y());
  }
  seen_ = std::min(seen_ + 1, kHeightMemory);
  for (std::size_t i = 0; i < models_.size(); ++i) {
    y_mm_[i] += (heights[i] - y_mm_[i]) / seen_;
    arc_mm_[i] = contacts[i].arc_mm;
  }
  return true;
}

std::optional<ModelController::MeanPush> ModelController::PushAt(
    double drive, const std::vector<ContactEstimate>& contacts) {
  const auto base = mechanism_.FingerPose(drive);
  if (!base) return std::nullopt;
  MeanPush mean;
  const double n = static_cast<double>(models_.size());
  for (std::size_t i = 0; i < models_.size(); ++i) {
    const auto push =
        models_[i].At(*base, y_mm_[i], contacts[i].normal_N, arc_mm_[i]);
    if (!push) return std::nullopt;
    mean.object_x_mm += push->object_x_mm / n;
    mean.compliance_mm_per_N += 1 / push->stiffness_N_per_mm / n;
    const double std_mm =
        contacts[i].normal_std_N / push->stiffness_N_per_mm / n;
    mean.variance_mm2 += std_mm * std_mm;
  }
  return mean;
}

// Solves X(F; u) = place for u by Newton's method with the mechanism's slope.
std::optional<double> ModelController::DriveFor(double force_N, double place_mm,
                                                double drive) {
  ContactEstimate contact;
  contact.normal_N = force_N;
  contact.normal_std_N = 0;
  const std::vector<ContactEstimate> wanted(models_.size(), contact);
  for (int i = 0; i < kMostDriveSteps; ++i) {
    const auto push = PushAt(drive, wanted);
    if (!push) return std::nullopt;
    const double gap = push->object_x_mm - place_mm;
    if (std::abs(gap) < kTolerance_mm) return drive;
    const double slope = mechanism_.ApproachPerDrive(drive, y_mm_.front());
    if (!(slope > 0)) return std::nullopt;
    drive += gap / slope;
  }
  return std::nullopt;
}

double ModelController::Next(double time_s,
                             const std::vector<ContactEstimate>& contacts,
                             const Trajectory& set_point,
                             const Actuator& drive) {
  const double now = drive.PredictAt(time_s);
  filter_.Predict();
  const auto push = SeeHeights(now, contacts) ? PushAt(now, contacts)
                                              : std::optional<MeanPush>();
  if (push) {
    const double approach = (now - last_drive_.value_or(now)) *
                            mechanism_.ApproachPerDrive(now, y_mm_.front());
    filter_.Update(push->object_x_mm, MeanForceOf(contacts).force_N,
                   std::hypot(std::sqrt(push->variance_mm2),
                              kLeastStd_N * push->compliance_mm_per_N,
                              approach / period_s_ * timing_std_s_));
  }
  last_drive_ = now;
  if (!filter_.started()) return drive.last_command();
  const double horizon = drive.settings().delay_s + drive.settings().period_s;
  const double force =
      std::max(0.0, set_point.At(preview_ ? time_s + horizon : time_s));
  const double place =
      filter_.PlaceIn(horizon) - filter_.compliance_mm_per_N() * force;
  const auto wanted = DriveFor(force, place, now);
  return wanted ? drive.CommandFor(time_s, *wanted) : drive.last_command();
}

}  // namespace finray
