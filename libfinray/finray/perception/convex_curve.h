#ifndef FINRAY_PERCEPTION_CONVEX_CURVE_H_
#define FINRAY_PERCEPTION_CONVEX_CURVE_H_

#include <Eigen/Core>

#include "finray/perception/normal_grid.h"

namespace finray {

/// A closed convex curve by its radius of curvature over the angle a of its
/// outward normal n(a) = (cos a, sin a), constant in each cell of a grid:
///
///   r(a) = r(o) + int_o^a rho(b) t(b) db,   t = dn/da,
///
/// o being the grid's origin: a chain of arcs that meet with one tangent. Any
/// rho >= 0 that closes, int rho t = 0 around, is a convex outline, a straight
/// edge being a peak and a sharp corner a stretch of 0.
class ConvexCurve {
 public:
  using Radii = Eigen::VectorXd;
  /// Derivatives of a point by the radii; those by the start are 1.
  using PointSlope = Eigen::Matrix<double, 2, Eigen::Dynamic>;

  ConvexCurve(const NormalGrid& grid, const Eigen::Vector2d& start_mm,
              const Radii& radii_mm);

  /// The point where the outward normal has this angle, any number of turns.
  Eigen::Vector2d At(double normal_angle_rad) const;
  /// Its derivative by the radii.
  static PointSlope SlopeAt(double normal_angle_rad, const NormalGrid& grid);
  /// That of the end of a turn, less that of the start.
  static PointSlope ClosureSlope(const NormalGrid& grid);

  /// The radius of curvature, averaged over normals within `reach_rad`.
  double MeanRadius(double normal_angle_rad, double reach_rad) const;

  const NormalGrid& grid() const { return grid_; }
  const Radii& radii_mm() const { return radii_; }
  const Eigen::Vector2d& start_mm() const { return start_; }
  double perimeter_mm() const;
  /// Arc length from the grid's origin, growing by the perimeter each turn.
  double ArcAt(double normal_angle_rad) const;
  /// The normal angle at an arc length, its inverse.
  double NormalAngleAt(double arc_mm) const;

 private:
  NormalGrid grid_;
  Eigen::Vector2d start_;
  Radii radii_;
};

}  // namespace finray

#endif  // FINRAY_PERCEPTION_CONVEX_CURVE_H_
