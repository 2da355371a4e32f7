#ifndef FINRAY_PERCEPTION_OUTLINE_FIT_H_
#define FINRAY_PERCEPTION_OUTLINE_FIT_H_

#include <Eigen/Core>
#include <vector>

#include "finray/perception/convex_curve.h"
#include "finray/perception/straight_edges.h"
#include "finray/perception/touch.h"

namespace finray {

// The convex outline that touches say: unknowns are u_j = log rho_j of a
// ConvexCurve and its start. Minimised is
//
//   sum_i H(|L_i^-1 e_i|^2) + lambda sum_j (u_j+1 - u_j)^2 / cell
//     + sum_k max(0, d_k)^2 / s_k^2,     e_i = point_i - r(normal angle_i),
//
//  - e_i is held to both the place and, as r is taken at the measured normal,
//    the direction of the beam. Its covariance L L' is that of the touch, whose
//    error of the angle shifts r by rho t, and that of the stage.
//  - H is Huber's loss, so that a touch gone astray does not bend the rest.
//  - The roughness of log rho has no preferred size: an edge of a polygon is as
//    well a peak as the round of an ellipse is flat.
//  - d_k > 0 is how far a point of the outline lies beyond a touch's beam.
//
// Stretches so flat that they may be straight edges (straight_edges.h) become
// such, lengths whose cells no roughness holds to their neighbours, if the
// touches away from them are more probable that way. Touches along them are
// then left out, but for their beams.
//
// lambda is the one at which the touches are most probable (restricted maximum
// likelihood, the scale s of their noise being unknown too),
//
//   n log(Q / n) + log det(A + lambda R) - log det+(lambda R) + 2 e log(s_e)
//
// over the n residuals of touches, Q being the minimum above, A the information
// of touches and beams, R that of the roughness, det+ leaving out its null
// space, e the number of edges and s_e the std of the logarithm of their
// length.

struct OutlineFitSettings {
  int cells = 180;
  double stage_std_mm = 0.02;  ///< of object_x_mm, object_y_mm, each.
  double beam_reach_mm = 140;  ///< The beam is a bound so near a contact.
};

struct OutlineFit {
  ConvexCurve curve{NormalGrid(1), {0, 0}, Eigen::VectorXd::Ones(1)};
  /// Of (u_1 .. u_M, start), from touches and roughness, with a noise of
  /// max(1, noise_scale).
  Eigen::MatrixXd covariance;
  double smoothing = 0;    ///< lambda
  double noise_scale = 0;  ///< s: noise of the touches over what they claim
  std::vector<StraightEdge> edges;
  /// |L_i^-1 e_i| of each touch, NaN along an edge.
  std::vector<double> distances;
  int beam_bounds = 0;  ///< that hold the outline in

  /// Std of the outline along its normal.
  double NormalStd(double normal_angle_rad) const;
};

/// Throws std::runtime_error if there is no minimum, std::invalid_argument for
/// fewer than three touches.
OutlineFit FitOutline(const std::vector<Touch>& touches,
                      const OutlineFitSettings& settings = {});

/// The same with lambda and edges given and starting from `start`, for touches
/// that differ a little (finger_variations.h); no covariance.
OutlineFit RefitOutline(const std::vector<Touch>& touches,
                        const OutlineFit& start,
                        const OutlineFitSettings& settings = {});

}  // namespace finray

#endif  // FINRAY_PERCEPTION_OUTLINE_FIT_H_
