#ifndef FINRAY_OBJECTS_OUTLINE_H_
#define FINRAY_OBJECTS_OUTLINE_H_

#include <Eigen/Core>
#include <optional>
#include <variant>
#include <vector>

namespace finray {

/// The pose of an object's own frame in frame S.
struct ObjectPose {
  Eigen::Vector2d position_mm = Eigen::Vector2d::Zero();
  double angle_rad = 0;
};

struct CircleOutline {
  double radius_mm;
};

/// The ellipse (x / a)^2 + (y / b)^2 = 1.
struct EllipseOutline {
  double semi_axis_x_mm, semi_axis_y_mm;
};

/// All points within `fillet_radius_mm` of a convex polygon: straight edges
/// parallel to the polygon's, and an arc of that radius about every vertex. One
/// vertex makes a circle, two make a stadium.
struct RoundedPolygonOutline {
  std::vector<Eigen::Vector2d> vertices_mm;
  double fillet_radius_mm;
};

/// A smooth outline given by its support function: the tangent whose outward
/// normal has the angle a lies at the distance
///
///   h(a) = r + sum_k a_k cos(k a) + b_k sin(k a),   k = 1, 2, ...
///
/// from the origin. The outline is convex if its radius of curvature h + h'' is
/// above 0 everywhere.
struct SupportOutline {
  double radius_mm;                             ///< r
  std::vector<Eigen::Vector2d> harmonics_mm{};  ///< (a_k, b_k) from k = 1
};

/// The closed convex boundary of a rigid object, in its own frame. It has a
/// tangent everywhere; its curvature may jump, as where an edge meets an arc.
///
/// A new shape needs a struct above, an entry in Shape, and in outline.cc a
/// check in the constructor and overloads of PointOf and DistanceFrom.
/// scene/scene.cc reads and writes its YAML.
class Outline {
 public:
  using Shape = std::variant<CircleOutline, EllipseOutline,
                             RoundedPolygonOutline, SupportOutline>;

  /// Vertices may run either way; they are stored counter-clockwise. Throws
  /// std::invalid_argument with the reason if a length is not positive or if
  /// the polygon or the support function is not convex.
  explicit Outline(const Shape& shape);

  const Shape& shape() const { return shape_; }
  /// The radius of a circle; nothing for other shapes.
  std::optional<double> circle_radius_mm() const;

  /// The boundary point p with the outward normal (cos a, sin a) and the radius
  /// of curvature rho there: dp/da = rho (-sin a, cos a). For the normal of a
  /// polygon's edge it is a point of one of the arcs beside the edge.
  struct Point {
    Eigen::Vector2d position_mm;
    double curvature_radius_mm;
  };
  Point PointAt(double normal_angle_rad) const;

  /// The distance d of a point from the boundary, negative inside, with the
  /// outward normal n at the nearest boundary point and the radius of curvature
  /// rho there (infinite on an edge). The derivatives by the point are
  ///
  ///   grad d = n,    grad n = t t' / (rho + d),    t = (-n_y, n_x).
  ///
  /// Deep inside, where several boundary points are nearest, it takes one of
  /// them.
  struct Distance {
    double distance_mm;
    Eigen::Vector2d normal;
    double curvature_radius_mm;
  };
  Distance DistanceOf(const Eigen::Vector2d& point_mm) const;
  /// The same for an object at a pose, with point and normal in frame S.
  Distance DistanceOf(const Eigen::Vector2d& point_mm,
                      const ObjectPose& pose) const;

 private:
  Shape shape_;
};

}  // namespace finray

#endif  // FINRAY_OBJECTS_OUTLINE_H_
