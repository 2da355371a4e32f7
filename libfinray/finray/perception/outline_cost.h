#ifndef FINRAY_PERCEPTION_OUTLINE_COST_H_
#define FINRAY_PERCEPTION_OUTLINE_COST_H_

#include <ceres/ceres.h>

#include <Eigen/Core>
#include <memory>

#include "finray/perception/convex_curve.h"

namespace finray {

/// A residual of outline_fit.h, linear in start and radii of a ConvexCurve:
///
///   e = d - A start - B exp(u).
///
/// Parameter blocks: u, the logarithms of the M radii in mm, and start in mm
/// (2).
class OutlineCost : public ceres::CostFunction {
 public:
  /// Whitening by rows, 1 or 2 of them.
  using Whitening = Eigen::Matrix<double, Eigen::Dynamic, 2>;

  /// W (point - r(normal angle)). If it is one-sided, a residual above 0 counts
  /// as 0.
  static std::unique_ptr<OutlineCost> Point(const Eigen::Vector2d& point_mm,
                                            double normal_angle_rad,
                                            const Whitening& whitening,
                                            bool one_sided,
                                            const NormalGrid& grid);
  /// The gap between the curve's ends over `std_mm`.
  static std::unique_ptr<OutlineCost> Closure(const NormalGrid& grid,
                                              double std_mm);

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  OutlineCost(const Eigen::VectorXd& offset, const Whitening& by_start,
              const Eigen::MatrixXd& by_radii, bool one_sided);

  Eigen::VectorXd offset_;
  Whitening by_start_;
  Eigen::MatrixXd by_radii_;
  bool one_sided_;
};

/// The matrix that turns u into its roughness, (u_k - u_j) / sqrt(distance of
/// the cells' middles) for neighbours j, k around. Straight edges are skipped;
/// their cells are linked to each other only.
Eigen::MatrixXd RoughnessMatrix(const NormalGrid& grid);

}  // namespace finray

#endif  // FINRAY_PERCEPTION_OUTLINE_COST_H_
