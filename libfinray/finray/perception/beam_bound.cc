#include "finray/perception/beam_bound.h"

#include <cmath>
#include <limits>

namespace finray {
namespace {

using Eigen::Vector2d;

// Closer to the contact, along the tangent, the beam says nothing new.
constexpr double kNearContact_mm = 2;
// Largest angle between the normals of the contact and of a point at its beam.
constexpr double kSector_rad = 1.2;
// A point farther beyond the beam lies on another side of the object.
constexpr double kDeepest_mm = 10;
constexpr double kNear = 3;  // std

struct Nearest {
  Vector2d point, normal;
  double beyond_mm = -std::numeric_limits<double>::infinity();
};

// The foot of the shortest perpendicular to a polyline, which runs from base to
// tip with the finger on its right.
Nearest NearestOf(const std::vector<Vector2d>& beam, const Vector2d& point) {
  Nearest nearest;
  for (std::size_t i = 0; i + 1 < beam.size(); ++i) {
    const Vector2d span = beam[i + 1] - beam[i];
    const double length = span.norm();
    const double along = span.dot(point - beam[i]) / length;
    if (along < 0 || along > length) continue;
    const Vector2d normal(span.y() / length, -span.x() / length);
    const double beyond = normal.dot(point - beam[i]);
    if (std::abs(beyond) >= std::abs(nearest.beyond_mm)) continue;
    nearest = {beam[i] + along / length * span, normal, beyond};
  }
  return nearest;
}

}  // namespace

std::vector<BeamBound> FindBeamBounds(const std::vector<Touch>& touches,
                                      const ConvexCurve& curve,
                                      double stage_std_mm, double reach_mm) {
  std::vector<BeamBound> bounds;
  const NormalGrid& grid = curve.grid();
  std::vector<Vector2d> points;
  for (Eigen::Index j = 0; j < grid.cells(); ++j) {
    points.push_back(curve.At(grid.Start(j)));
  }
  for (const Touch& touch : touches) {
    const std::vector<Vector2d> beam = touch.BeamNear(reach_mm);
    const Vector2d normal = touch.Normal();
    const Vector2d tangent(-normal.y(), normal.x());
    const double normal_variance =
        normal.dot(touch.covariance.topLeftCorner<2, 2>() * normal) +
        stage_std_mm * stage_std_mm;
    for (std::size_t j = 0; j < points.size(); ++j) {
      const double angle = grid.Start(static_cast<Eigen::Index>(j));
      if (std::abs(std::remainder(angle - touch.normal_angle_rad, 2 * M_PI)) >
          kSector_rad) {
        continue;
      }
      const double aside = tangent.dot(points[j] - touch.point_mm);
      if (std::abs(aside) < kNearContact_mm) continue;
      const double std_mm =
          std::sqrt(normal_variance + aside * aside * touch.covariance(2, 2));
      const Nearest nearest = NearestOf(beam, points[j]);
      if (nearest.beyond_mm < -kNear * std_mm ||
          nearest.beyond_mm > kDeepest_mm) {
        continue;
      }
      bounds.push_back({angle, nearest.point, nearest.normal, std_mm});
    }
  }
  return bounds;
}

}  // namespace finray
