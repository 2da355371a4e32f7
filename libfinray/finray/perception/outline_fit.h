#ifndef FINRAY_PERCEPTION_OUTLINE_FIT_H_
#define FINRAY_PERCEPTION_OUTLINE_FIT_H_

#include <Eigen/Core>
#include <vector>

#include "finray/perception/beam_bound.h"
#include "finray/perception/contact_sensor.h"
#include "finray/perception/convex_curve.h"
#include "finray/perception/straight_edges.h"

namespace finray {

// Fits a convex outline to touches. The unknowns are u_j = log rho_j of a
// ConvexCurve and its start; the fit minimises
//
//   sum_i H(|L_i^-1 e_i|^2) + lambda sum_j (u_j+1 - u_j)^2 / cell
//     + sum_k max(0, d_k)^2 / s_k^2,     e_i = point_i - r(normal angle_i).
//
//  - e_i compares the touch with the outline at the measured normal, so it uses
//    both place and direction of the beam. Its covariance L L' is that of the
//    touch (an error of the angle shifts r by rho t) plus that of the stage.
//  - H is Huber's loss: a single wrong touch does not bend the outline.
//  - The roughness of log rho prefers no size: the narrow peak of an edge costs
//    no more than the flat side of an ellipse.
//  - d_k > 0 is the distance of an outline point beyond a touch's beam.
//
// A stretch that is nearly flat becomes a straight edge (straight_edges.h) if
// the touches away from it are then more probable. An edge has its length as an
// unknown, which no roughness ties to its neighbours; the touches along it
// count only as bounds.
//
// lambda is the one that makes the touches most probable (restricted maximum
// likelihood with an unknown scale s of their noise). It minimises
//
//   n log(Q / n) + log det(A + lambda R) - log det+(lambda R) + 2 e log(s_e)
//
// with n residuals of touches, the minimum Q above, the information A of
// touches and beams, the information R of the roughness, det+ without its null
// space, e edges, and s_e the std of the logarithm of an edge's length.

/// The std of object_x_mm and of object_y_mm.
constexpr double kStageStd_mm = 0.02;

struct OutlineFit {
  ConvexCurve curve{NormalGrid(1), {0, 0}, Eigen::VectorXd::Ones(1)};
  /// Of (u_1 .. u_M, start), from touches, beams and roughness, with the noise
  /// scaled by max(1, noise_scale).
  Eigen::MatrixXd covariance;
  double smoothing = 0;    ///< lambda
  double noise_scale = 0;  ///< s, the scatter of the touches over their std
  std::vector<StraightEdge> edges;
  /// |L_i^-1 e_i| of each touch; NaN along an edge.
  std::vector<double> distances;
  int beam_bounds = 0;  ///< number of bounds that hold the outline in

  /// Std of the outline along its normal, in mm.
  double NormalStd(double normal_angle_rad) const;
};

/// Throws std::invalid_argument for fewer than three touches and
/// std::runtime_error if there is no minimum.
OutlineFit FitOutline(const std::vector<Touch>& touches,
                      double stage_std_mm = kStageStd_mm);

/// Fits slightly different touches (FingerVariations), starting from `start`
/// and with its lambda and edges. Throws std::runtime_error without a minimum.
ConvexCurve RefitOutline(const std::vector<Touch>& touches,
                         const OutlineFit& start, double stage_std_mm);

}  // namespace finray

#endif  // FINRAY_PERCEPTION_OUTLINE_FIT_H_
