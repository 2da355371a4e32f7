#ifndef FINRAY_PERCEPTION_OUTLINE_COST_H_
#define FINRAY_PERCEPTION_OUTLINE_COST_H_

#include <ceres/ceres.h>

#include <Eigen/Core>
#include <vector>

#include "finray/perception/contact_sensor.h"
#include "finray/perception/convex_curve.h"

namespace finray {

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

/// A touch's beam keeps a point r of the outline on the object's side:
/// n . (b - r(normal angle)) >= 0, where b is the nearest point of the beam and
/// n its normal into the finger.
struct BeamBound {
  double normal_angle_rad;
  Eigen::Vector2d beam_point_mm, beam_normal;
  double std_mm;  ///< of b along n
};

/// The bounds of all touches for those points of `curve` that are beyond a beam
/// or within its error of it. Points near a contact get none: the touch itself,
/// where the outline is tangent to the beam, says more. Beams count within
/// `reach_mm` of their contact.
std::vector<BeamBound> FindBeamBounds(const std::vector<Touch>& touches,
                                      const ConvexCurve& curve,
                                      double stage_std_mm, double reach_mm);

}  // namespace finray

#endif  // FINRAY_PERCEPTION_OUTLINE_COST_H_
