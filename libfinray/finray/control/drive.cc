#include "finray/control/drive.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace finray {
namespace {

using Eigen::Vector2d;

// Positive if the rocker's joint is on the left of the way from the crank's
// joint to the rocker's pivot, at angle 0.
double SideOfRocker(const FourBar& joints) {
  return Cross(Vector2d(joints.rocker_pivot_mm - joints.crank_joint_mm),
               Vector2d(joints.rocker_joint_mm - joints.crank_joint_mm));
}

}  // namespace

Actuator::Actuator(const ActuatorSettings& settings, double start)
    : settings_(settings),
      position_(start),
      command_(start),
      last_command_(start) {}

void Actuator::Command(double time_s, double position) {
  in_flight_.push_back({time_s + settings_.delay_s, position});
  last_command_ = position;
}

double Actuator::AdvanceTo(double time_s) {
  while (!in_flight_.empty() && in_flight_.front().arrives_s <= time_s) {
    Move(in_flight_.front().arrives_s - time_s_);
    command_ = in_flight_.front().position;
    in_flight_.pop_front();
  }
  Move(time_s - time_s_);
  return position_;
}

double Actuator::PredictAt(double time_s) const {
  return Actuator(*this).AdvanceTo(time_s);
}

double Actuator::CommandFor(double time_s, double position) const {
  const double start = PredictAt(time_s + settings_.delay_s);
  if (!(settings_.time_constant_s > 0)) return position;
  const double share =
      -std::expm1(-settings_.period_s / settings_.time_constant_s);
  return start + (position - start) / share;
}

void Actuator::Move(double seconds) {
  if (!(seconds > 0)) return;
  time_s_ += seconds;
  const double tau = settings_.time_constant_s, limit = settings_.speed_limit;
  // The drive moves at the speed limit until the servo asks for less.
  const double way = command_ - position_;
  const double beyond = std::abs(way) - limit * tau;
  if (beyond > 0) {
    const double ramp_s = std::min(seconds, beyond / limit);
    position_ += std::copysign(limit * ramp_s, way);
    seconds -= ramp_s;
  }
  if (tau > 0) {
    position_ -= (command_ - position_) * std::expm1(-seconds / tau);
  }
}

std::optional<Pose<double>> FourBar::Coupler(double crank_rad) const {
  const Pose<double> turn = MakePose<double>(crank_rad, Vector2d::Zero());
  const Vector2d crank = crank_joint_mm - crank_pivot_mm;
  const Vector2d before = rocker_joint_mm - crank_joint_mm;
  const Vector2d b = crank_pivot_mm + turn.Rotate(crank);
  const Vector2d way = rocker_pivot_mm - b;
  const double distance = way.norm(), coupler = before.norm();
  const double rocker = (rocker_joint_mm - rocker_pivot_mm).norm();
  const double along =
      (distance * distance + coupler * coupler - rocker * rocker) /
      (2 * distance);
  const double square = coupler * coupler - along * along;
  if (!(square > 0)) return std::nullopt;
  const double across = std::copysign(std::sqrt(square), SideOfRocker(*this));
  const Vector2d unit = way / distance;
  const Vector2d c = b + along * unit + across * Turned<double>(unit);
  const Vector2d after = c - b;
  Pose<double> pose = MakePose<double>(
      std::atan2(Cross(before, after), before.dot(after)), Vector2d::Zero());
  pose.t = b - pose.Rotate(crank_joint_mm);
  return pose;
}

Mechanism::Mechanism(const FourBar& joints) : four_bar_(joints) {
  const double crank = (joints.crank_joint_mm - joints.crank_pivot_mm).norm();
  const double coupler =
      (joints.rocker_joint_mm - joints.crank_joint_mm).norm();
  const double rocker =
      (joints.rocker_joint_mm - joints.rocker_pivot_mm).norm();
  if (!(crank > 0 && coupler > 0 && rocker > 0)) {
    throw std::invalid_argument("joints of one link coincide");
  }
  if (std::abs(SideOfRocker(joints)) < 1e-6 * coupler * rocker) {
    throw std::invalid_argument("coupler and rocker lie in one line");
  }
  const double approach = ApproachPerDrive(0, 0);
  if (!(std::abs(approach) > 1e-6)) {
    throw std::invalid_argument(
        "the linkage does not move the finger towards the object");
  }
  if (approach < 0) sense_ = -1;
}

std::optional<Pose<double>> Mechanism::FingerPose(double drive) const {
  if (four_bar_) return four_bar_->Coupler(sense_ * drive);
  return MakePose<double>(0, Vector2d(-drive, 0));
}

double Mechanism::ApproachPerDrive(double drive, double y_mm) const {
  constexpr double kStep = 1e-4;
  const auto here = FingerPose(drive), before = FingerPose(drive - kStep),
             after = FingerPose(drive + kStep);
  if (!here || !before || !after) return 0;
  const Vector2d point = here->Inverse() * Vector2d(0, y_mm);
  return ((*before * point) - (*after * point)).x() / (2 * kStep);
}

}  // namespace finray
