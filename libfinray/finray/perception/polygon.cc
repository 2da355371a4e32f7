#include "finray/perception/polygon.h"

#include <cmath>

namespace finray {

using Eigen::Vector2d;

double Cross(const Vector2d& a, const Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

double AreaOf(const Polygon& polygon) {
  double twice = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    twice += Cross(polygon[i], polygon[(i + 1) % polygon.size()]);
  }
  return twice / 2;
}

Vector2d CentroidOf(const Polygon& polygon) {
  // About the first point, so that a far-off origin costs no digits.
  Vector2d moment(0, 0);
  double twice = 0;
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
    const Vector2d a = polygon[i] - polygon[0], b = polygon[i + 1] - polygon[0];
    moment += Cross(a, b) * (a + b) / 3;
    twice += Cross(a, b);
  }
  return polygon[0] + moment / twice;
}

Polygon EvenlySpaced(const Polygon& polygon, int count) {
  const std::size_t n = polygon.size();
  std::vector<double> arc(1, 0);
  for (std::size_t i = 0; i < n; ++i) {
    arc.push_back(arc.back() + (polygon[(i + 1) % n] - polygon[i]).norm());
  }
  Polygon even;
  std::size_t edge = 0;
  for (int k = 0; k < count; ++k) {
    const double at = arc.back() * k / count;
    while (edge + 1 < n && arc[edge + 1] <= at) ++edge;
    const double length = arc[edge + 1] - arc[edge];
    const double share = length > 0 ? (at - arc[edge]) / length : 0;
    even.push_back((1 - share) * polygon[edge] +
                   share * polygon[(edge + 1) % n]);
  }
  return even;
}

std::optional<double> RadiusAt(const Polygon& polygon, const Vector2d& centre,
                               double angle_rad) {
  const Vector2d ray(std::cos(angle_rad), std::sin(angle_rad));
  std::optional<double> radius;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector2d a = polygon[i] - centre;
    const Vector2d b = polygon[(i + 1) % polygon.size()] - centre;
    const double above_a = Cross(ray, a), above_b = Cross(ray, b);
    if (above_a == above_b || (above_a > 0) == (above_b > 0)) continue;
    const double share = above_a / (above_a - above_b);
    const double along = ray.dot((1 - share) * a + share * b);
    if (along >= 0 && along > radius.value_or(0)) radius = along;
  }
  return radius;
}

}  // namespace finray
