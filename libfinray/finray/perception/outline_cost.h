#ifndef FINRAY_PERCEPTION_OUTLINE_COST_H_
#define FINRAY_PERCEPTION_OUTLINE_COST_H_

#include <ceres/ceres.h>

#include <Eigen/Core>
#include <vector>

#include "finray/perception/convex_curve.h"

namespace finray {

// Ceres blocks of outline_fit.h. Parameter blocks: u = log of the radii of
// curvature in mm (M), and the curve's start in mm (2).

/// W (point - r(normal angle)), W (1 or 2 rows) being whitening by rows.
class OutlinePointCost : public ceres::CostFunction {
 public:
  using Whitening = Eigen::Matrix<double, Eigen::Dynamic, 2>;
  /// One-sided: a residual above 0 counts as 0.
  OutlinePointCost(const Eigen::Vector2d& point_mm, double normal_angle_rad,
                   const Whitening& whitening, bool one_sided,
                   const NormalGrid& grid);
  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  Eigen::Vector2d point_;
  Whitening whitening_;
  bool one_sided_;
  ConvexCurve::PointSlope slope_;
};

/// (u_k - u_j) / sqrt(distance of the cells' middles) for neighbours j, k
/// around, passing over straight edges, whose cells are held to each other
/// only; one block, u.
class OutlineRoughnessCost : public ceres::CostFunction {
 public:
  explicit OutlineRoughnessCost(const NormalGrid& grid);
  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  struct Link {
    Eigen::Index from, to;
    double weight;
  };
  Eigen::Index cells_;
  std::vector<Link> links_;
};

/// The gap between the curve's ends over `std_mm`, far less than any error of a
/// touch; one block, u.
class OutlineClosureCost : public ceres::CostFunction {
 public:
  OutlineClosureCost(const NormalGrid& grid, double std_mm);
  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  ConvexCurve::PointSlope slope_;
};

}  // namespace finray

#endif  // FINRAY_PERCEPTION_OUTLINE_COST_H_
