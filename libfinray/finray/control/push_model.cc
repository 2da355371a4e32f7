#include "finray/control/push_model.h"

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

}  // namespace

PushModel::PushModel(const Finger& finger, double radius_mm, double friction,
                     const Discretization& discretization)
    : solver_(finger, discretization),
      radius_mm_(radius_mm),
      friction_(friction) {}

bool PushModel::Solve(const Pose<double>& base, double arc_mm,
                      double normal_N) {
  if (!solver_.SolveWithSensitivities({{arc_mm, normal_N, friction_}})) {
    return false;
  }
  const Vector3d pose = solver_.contact_pose(0);
  const Vector2d tangent(std::cos(pose.z()), std::sin(pose.z()));
  const Vector2d normal = -Turned<double>(tangent);
  centre_ = base * Vector2d(pose.head<2>() - radius_mm_ * normal);
  const int row = solver_.model().gauges();
  const auto derivative = [&](int column) {
    const Vector3d d = solver_.d_outputs().block<3, 1>(row, column);
    // dn/dtheta = t.
    return base.Rotate(d.head<2>() - radius_mm_ * d.z() * tangent);
  };
  by_arc_ = derivative(0);
  by_force_ = derivative(1);
  return true;
}

std::optional<Vector2d> PushModel::Centre(const Pose<double>& base,
                                          double arc_mm, double normal_N) {
  if (!Solve(base, arc_mm, normal_N)) return std::nullopt;
  return centre_;
}

std::optional<Push> PushModel::At(const Pose<double>& base, double y_mm,
                                  double normal_N, double arc_mm) {
  const double end = solver_.model().finger().front_length_mm - kEnd_mm;
  arc_mm = std::clamp(arc_mm, kEnd_mm, end);
  for (int i = 0; i < kMostIterations; ++i) {
    if (!Solve(base, arc_mm, normal_N)) return std::nullopt;
    const double gap = y_mm - centre_.y();
    const double step = gap / by_arc_.y();
    if (std::abs(gap) < kGapTolerance_mm) {
      const double compliance =
          by_force_.x() - by_arc_.x() * by_force_.y() / by_arc_.y();
      return Push{centre_.x(), arc_mm, 1 / compliance};
    }
    const double next =
        std::clamp(arc_mm + std::clamp(step, -kLongestStep_mm, kLongestStep_mm),
                   kEnd_mm, end);
    if (!std::isfinite(step) || next == arc_mm) return std::nullopt;
    arc_mm = next;
  }
  return std::nullopt;
}

}  // namespace finray
