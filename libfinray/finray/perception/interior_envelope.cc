#include "finray/perception/interior_envelope.h"

#include <cmath>
#include <limits>

namespace finray {
namespace {

using Eigen::Vector2d;

// How far along a ray the piece from a to b is met; infinite if it is not.
double Crossing(const Vector2d& ray, const Vector2d& a, const Vector2d& b) {
  const double above_a = Cross(ray, a), above_b = Cross(ray, b);
  const double infinite = std::numeric_limits<double>::infinity();
  if (above_a == above_b || (above_a > 0) == (above_b > 0)) return infinite;
  const double share = above_a / (above_a - above_b);
  const double along = ray.dot((1 - share) * a + share * b);
  return along > 0 ? along : infinite;
}

}  // namespace

Polygon InteriorEnvelope(const std::vector<Touch>& touches, double reach_mm,
                         int count) {
  Vector2d centre(0, 0);
  std::vector<std::vector<Vector2d>> pieces;
  for (const Touch& touch : touches) {
    centre += touch.point_mm / static_cast<double>(touches.size());
    pieces.push_back(touch.BeamNear(reach_mm));
  }
  Polygon contour;
  for (int i = 0; i < count; ++i) {
    const double angle = 2 * M_PI * i / count;
    const Vector2d ray(std::cos(angle), std::sin(angle));
    double first = std::numeric_limits<double>::infinity();
    for (const auto& piece : pieces) {
      for (std::size_t k = 0; k + 1 < piece.size(); ++k) {
        first = std::min(
            first, Crossing(ray, piece[k] - centre, piece[k + 1] - centre));
      }
    }
    if (std::isfinite(first)) contour.push_back(centre + first * ray);
  }
  return contour;
}

}  // namespace finray
