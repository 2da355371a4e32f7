#ifndef FINRAY_PERCEPTION_CONVEX_CURVE_H_
#define FINRAY_PERCEPTION_CONVEX_CURVE_H_

#include <ceres/ceres.h>

#include <Eigen/Core>
#include <vector>

namespace finray {

/// The widest gap between directions around a circle, counter-clockwise from
/// one to the next, 0 <= from_rad < 2 pi. A full turn from -pi without any
/// direction.
struct AngleGap {
  double from_rad, to_rad;
};
AngleGap WidestGap(std::vector<double> angles_rad);

/// Cells of the normal's angle, once around an outline. They are equally wide,
/// but each straight edge has a few narrow cells that hold its length. The
/// origin is far from all edges.
class NormalGrid {
 public:
  static constexpr int kEdgeCells = 3;
  static constexpr double kEdgeCell_rad = 0.003;

  explicit NormalGrid(int cells,
                      const std::vector<double>& edge_angles_rad = {});

  Eigen::Index cells() const { return bounds_.size() - 1; }
  double Start(Eigen::Index cell) const { return bounds_[cell]; }
  double Width(Eigen::Index cell) const {
    return bounds_[cell + 1] - bounds_[cell];
  }
  double origin_rad() const { return bounds_[0]; }
  /// The cell of an angle within one turn from the origin.
  Eigen::Index CellOf(double angle_rad) const;
  double Middle(Eigen::Index cell) const {
    return bounds_[cell] + 0.5 * Width(cell);
  }
  /// Whether the cell belongs to a straight edge.
  bool IsEdge(Eigen::Index cell) const {
    return edge_[static_cast<std::size_t>(cell)];
  }

 private:
  Eigen::VectorXd bounds_;
  std::vector<bool> edge_;
};

/// A closed convex curve (mm), given by its radius of curvature rho over the
/// angle a of its outward normal n(a) = (cos a, sin a):
///
///   r(a) = r(o) + int_o^a rho(b) t(b) db,   t = dn/da.
///
/// rho is constant in each cell of a grid with origin o, so the curve is a
/// chain of arcs with continuous tangents. It is a convex outline if rho >= 0
/// and if it closes, int rho t = 0 over a turn. A straight edge is a peak of
/// rho, a sharp corner a stretch with rho = 0.
class ConvexCurve {
 public:
  using Radii = Eigen::VectorXd;
  /// Derivative of a point by the radii. (Its derivative by the start is 1.)
  using PointSlope = Eigen::Matrix<double, 2, Eigen::Dynamic>;

  ConvexCurve(const NormalGrid& grid, const Eigen::Vector2d& start_mm,
              const Radii& radii_mm);

  /// The point where the outward normal has this angle, after any number of
  /// turns.
  Eigen::Vector2d At(double normal_angle_rad) const;
  /// Its derivative by the radii.
  static PointSlope SlopeAt(double normal_angle_rad, const NormalGrid& grid);

  /// The radius of curvature there.
  double RadiusAt(double normal_angle_rad) const;
  /// The mean radius of curvature over the normals within `reach_rad`.
  double MeanRadius(double normal_angle_rad, double reach_rad) const;

  const NormalGrid& grid() const { return grid_; }
  const Radii& radii_mm() const { return radii_; }
  const Eigen::Vector2d& start_mm() const { return start_; }
  double perimeter_mm() const { return arcs_[grid_.cells()]; }
  /// Arc length from the grid's origin, growing by the perimeter each turn.
  double ArcAt(double normal_angle_rad) const;
  /// The normal angle at an arc length, its inverse, and the point there.
  double NormalAngleAt(double arc_mm) const;
  Eigen::Vector2d AtArc(double arc_mm) const {
    return At(NormalAngleAt(arc_mm));
  }

 private:
  NormalGrid grid_;
  Eigen::Vector2d start_;
  Radii radii_;
  // Arc lengths where the cells start, and the perimeter.
  Eigen::VectorXd arcs_;
};

/// A residual of outline_fit.h, linear in radii and start of a ConvexCurve:
///
///   e = d - A (exp(u), start).
///
/// Its parameter block is (u, start): the logarithms of the M radii in mm, then
/// the start in mm.
class OutlineCost : public ceres::CostFunction {
 public:
  /// Whitening by rows, 1 or 2 of them.
  using Whitening = Eigen::Matrix<double, Eigen::Dynamic, 2>;

  /// W (point - r(normal angle)). If it is one-sided, a residual above 0 counts
  /// as 0.
  OutlineCost(const Eigen::Vector2d& point_mm, double normal_angle_rad,
              const Whitening& whitening, bool one_sided,
              const NormalGrid& grid);
  /// The gap between the curve's ends over `std_mm`.
  OutlineCost(const NormalGrid& grid, double std_mm);

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  Eigen::VectorXd offset_;
  Eigen::MatrixXd rows_;
  bool one_sided_;
};

/// The matrix that turns u into its roughness, (u_k - u_j) / sqrt(distance of
/// the cells' middles) for neighbours j, k around. Straight edges are skipped;
/// their cells are linked to each other only.
Eigen::MatrixXd RoughnessMatrix(const NormalGrid& grid);

}  // namespace finray

#endif  // FINRAY_PERCEPTION_CONVEX_CURVE_H_
