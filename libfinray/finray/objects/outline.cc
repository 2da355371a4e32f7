#include "finray/objects/outline.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "finray/chain/se2.h"

namespace finray {
namespace {

using Eigen::Vector2d;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// The sine of a polygon's corner that still counts as straight.
constexpr double kStraight = 1e-9;

void CheckLength(double length, const char* what) {
  // Written so that a NaN fails.
  if (!(length > 0 && std::isfinite(length))) {
    throw std::invalid_argument(std::string(what) +
                                ": expected a length above 0 mm");
  }
}

// Orders vertices counter-clockwise and throws if the polygon is not convex.
void Normalize(std::vector<Vector2d>* vertices) {
  const std::size_t n = vertices->size();
  if (n == 0) throw std::invalid_argument("a polygon needs vertices");
  const auto edge = [&](std::size_t i) {
    return Vector2d((*vertices)[(i + 1) % n] - (*vertices)[i % n]);
  };
  double turn = 0, area = 0;
  for (std::size_t i = 0; i < n; ++i) {
    if (!(*vertices)[i].allFinite()) {
      throw std::invalid_argument("a vertex is not finite");
    }
    area += Cross((*vertices)[i], (*vertices)[(i + 1) % n]);
  }
  for (std::size_t i = 0; n > 1 && i < n; ++i) {
    if (edge(i).norm() == 0) {
      throw std::invalid_argument("two neighbouring vertices are equal");
    }
  }
  if (n < 3) return;
  if (area < 0) std::reverse(vertices->begin(), vertices->end());
  for (std::size_t i = 0; i < n; ++i) {
    const Vector2d a = edge(i).normalized(), b = edge(i + 1).normalized();
    if (!(Cross(a, b) > kStraight)) {
      throw std::invalid_argument(
          "the vertices are not those of a convex polygon, each a corner, in "
          "order around it");
    }
    turn += std::atan2(Cross(a, b), a.dot(b));
  }
  // A star turns the same way at all corners, but by more than one full turn.
  if (turn > 3 * M_PI) {
    throw std::invalid_argument("the polygon's edges cross");
  }
}

Outline::Point PointOf(const EllipseOutline& ellipse, const Vector2d& normal) {
  const Vector2d squares(ellipse.semi_axis_x_mm * ellipse.semi_axis_x_mm,
                         ellipse.semi_axis_y_mm * ellipse.semi_axis_y_mm);
  const Vector2d scaled = squares.cwiseProduct(normal);
  const double support = std::sqrt(scaled.dot(normal));
  return {scaled / support,
          squares.x() * squares.y() / (support * support * support)};
}

Outline::Point PointOf(const RoundedPolygonOutline& polygon,
                       const Vector2d& normal) {
  const auto& vertices = polygon.vertices_mm;
  const Vector2d& corner =
      *std::max_element(vertices.begin(), vertices.end(),
                        [&](const Vector2d& a, const Vector2d& b) {
                          return a.dot(normal) < b.dot(normal);
                        });
  return {corner + polygon.fillet_radius_mm * normal, polygon.fillet_radius_mm};
}

Outline::Point PointOf(const CircleOutline& circle, const Vector2d& normal) {
  return {circle.radius_mm * normal, circle.radius_mm};
}

Outline::Point PointOf(const SupportOutline& outline, const Vector2d& normal) {
  const Vector2d tangent(-normal.y(), normal.x());
  double support = outline.radius_mm, slope = 0, bend = 0;
  Vector2d turn(1, 0);  // (cos, sin) of k times the normal's angle
  for (std::size_t k = 1; k <= outline.harmonics_mm.size(); ++k) {
    turn = {turn.x() * normal.x() - turn.y() * normal.y(),
            turn.y() * normal.x() + turn.x() * normal.y()};
    const Vector2d& ab = outline.harmonics_mm[k - 1];
    const double order = static_cast<double>(k);
    support += ab.dot(turn);
    slope += order * Cross(turn, ab);
    bend -= order * order * ab.dot(turn);
  }
  return {support * normal + slope * tangent, support + bend};
}

void CheckConvex(const SupportOutline& outline) {
  constexpr int kNormals = 3600;
  for (const Vector2d& harmonic : outline.harmonics_mm) {
    if (!harmonic.allFinite()) {
      throw std::invalid_argument("a harmonic is not finite");
    }
  }
  for (int i = 0; i < kNormals; ++i) {
    const double angle = 2 * M_PI * i / kNormals;
    const Vector2d normal(std::cos(angle), std::sin(angle));
    if (!(PointOf(outline, normal).curvature_radius_mm > 0)) {
      throw std::invalid_argument(
          "the outline is not convex: its radius of curvature h + h'' is not "
          "above 0 at a normal of " +
          std::to_string(i * 360 / kNormals) + " deg");
    }
  }
}

// The boundary point q(a) nearest to the point p, where t(a) . (p - q(a)) falls
// through zero; its slope by a is -(d + rho). Newton's method from `angle`,
// bisection where it leaves low .. high.
template <class Shape>
Outline::Distance NearestPoint(const Shape& shape, const Vector2d& p,
                               double angle, double low, double high) {
  const double start = low;
  Outline::Distance nearest;
  for (int i = 0; i < 100; ++i) {
    const Vector2d normal(std::cos(angle), std::sin(angle));
    const Vector2d tangent(-normal.y(), normal.x());
    const Outline::Point q = PointOf(shape, normal);
    const Vector2d offset = p - q.position_mm;
    nearest = {offset.dot(normal), normal, q.curvature_radius_mm};
    const double ahead = offset.dot(tangent);
    const double fall = nearest.distance_mm + q.curvature_radius_mm;
    if (fall > 0 && std::abs(ahead) <= 1e-15 * fall) break;
    // On an axis of an ellipse `ahead` is zero at its start too.
    (ahead > 0 || (ahead == 0 && angle == start) ? low : high) = angle;
    double next = angle + ahead / fall;
    if (!(fall > 0 && next > low && next < high)) next = 0.5 * (low + high);
    if (next == angle) break;
    angle = next;
  }
  return nearest;
}

// The nearest point of an ellipse lies in the quadrant of the point.
Outline::Distance DistanceFrom(const EllipseOutline& ellipse,
                               const Vector2d& point) {
  const Vector2d p = point.cwiseAbs();
  // The first guess is exact on the axes and for a circle.
  Outline::Distance nearest =
      NearestPoint(ellipse, p, std::atan2(p.y(), p.x()), 0, M_PI / 2);
  nearest.normal = {std::copysign(nearest.normal.x(), point.x()),
                    std::copysign(nearest.normal.y(), point.y())};
  return nearest;
}

// From outside, the nearest point's normal is within a right angle of the
// direction of the point. The first harmonic only shifts the outline; the
// shifted centre is always inside.
Outline::Distance DistanceFrom(const SupportOutline& outline,
                               const Vector2d& point) {
  const auto& harmonics = outline.harmonics_mm;
  const Vector2d centre = harmonics.empty() ? Vector2d(0, 0) : harmonics[0];
  const double angle =
      std::atan2(point.y() - centre.y(), point.x() - centre.x());
  return NearestPoint(outline, point, angle, angle - M_PI / 2,
                      angle + M_PI / 2);
}

Outline::Distance DistanceFrom(const RoundedPolygonOutline& polygon,
                               const Vector2d& point) {
  const auto& vertices = polygon.vertices_mm;
  const std::size_t n = vertices.size();
  Outline::Distance edge{-kInfinity, {1, 0}, kInfinity};
  Outline::Distance nearest{kInfinity, {1, 0}, kInfinity};
  bool inside = n > 2;
  for (std::size_t i = 0; i < n; ++i) {
    const Vector2d from_vertex = point - vertices[i];
    const double distance = from_vertex.norm();
    if (distance > 0 && distance < nearest.distance_mm) {
      nearest = {distance, from_vertex / distance, polygon.fillet_radius_mm};
    }
    if (n == 1) break;
    const Vector2d span = vertices[(i + 1) % n] - vertices[i];
    const double length = span.norm();
    const Vector2d outward(span.y() / length, -span.x() / length);
    const double above = outward.dot(from_vertex);
    if (above > edge.distance_mm) edge = {above, outward, kInfinity};
    if (above > 0) inside = false;
    const double along = span.dot(from_vertex) / length;
    if (above >= 0 && above < nearest.distance_mm && along >= 0 &&
        along <= length) {
      nearest = {above, outward, kInfinity};
    }
  }
  Outline::Distance result = inside ? edge : nearest;
  // At the centre of a circle all boundary points are equally near.
  if (result.distance_mm == kInfinity) {
    result = {0, {1, 0}, polygon.fillet_radius_mm};
  }
  result.distance_mm -= polygon.fillet_radius_mm;
  return result;
}

Outline::Distance DistanceFrom(const CircleOutline& circle,
                               const Vector2d& point) {
  const double from_center = point.norm();
  const Vector2d normal =
      from_center > 0 ? Vector2d(point / from_center) : Vector2d(1, 0);
  return {from_center - circle.radius_mm, normal, circle.radius_mm};
}

}  // namespace

Outline::Outline(const Shape& shape) : shape_(shape) {
  if (const auto* circle = std::get_if<CircleOutline>(&shape_)) {
    CheckLength(circle->radius_mm, "the radius");
  } else if (const auto* ellipse = std::get_if<EllipseOutline>(&shape_)) {
    CheckLength(ellipse->semi_axis_x_mm, "the semi-axis along x");
    CheckLength(ellipse->semi_axis_y_mm, "the semi-axis along y");
  } else if (auto* polygon = std::get_if<RoundedPolygonOutline>(&shape_)) {
    CheckLength(polygon->fillet_radius_mm, "the fillet radius");
    Normalize(&polygon->vertices_mm);
  } else if (const auto* support = std::get_if<SupportOutline>(&shape_)) {
    CheckLength(support->radius_mm, "the radius");
    CheckConvex(*support);
  }
}

std::optional<double> Outline::circle_radius_mm() const {
  const auto* circle = std::get_if<CircleOutline>(&shape_);
  if (circle == nullptr) return std::nullopt;
  return circle->radius_mm;
}

Outline::Point Outline::PointAt(double normal_angle_rad) const {
  const Vector2d normal(std::cos(normal_angle_rad), std::sin(normal_angle_rad));
  return std::visit([&](const auto& shape) { return PointOf(shape, normal); },
                    shape_);
}

Outline::Distance Outline::DistanceOf(const Vector2d& point_mm) const {
  return std::visit(
      [&](const auto& shape) { return DistanceFrom(shape, point_mm); }, shape_);
}

Outline::Distance Outline::DistanceOf(const Vector2d& point_mm,
                                      const ObjectPose& pose) const {
  const Eigen::Rotation2Dd turn(pose.angle_rad);
  Distance distance =
      DistanceOf(Vector2d(turn.inverse() * (point_mm - pose.position_mm)));
  distance.normal = turn * distance.normal;
  return distance;
}

}  // namespace finray
