#ifndef FINRAY_PERCEPTION_BEAM_BOUNDS_H_
#define FINRAY_PERCEPTION_BEAM_BOUNDS_H_

#include <vector>

#include "finray/perception/convex_curve.h"
#include "finray/perception/touch.h"

namespace finray {

/// A point of an outline that comes near a touch's beam, away from the contact:
/// n . (b - r(normal angle)) >= 0 keeps it on the object's side, b being the
/// nearest point of the beam and n its normal into the finger.
struct BeamBound {
  double normal_angle_rad;
  Eigen::Vector2d beam_point_mm, beam_normal;
  double std_mm;  ///< of the beam's place along n
};

/// The points of `curve` that are beyond a beam or as near to it as its error
/// is large, of all touches. Those near the contact are left out: that the
/// outline is tangent there says more.
std::vector<BeamBound> FindBeamBounds(const std::vector<Touch>& touches,
                                      const ConvexCurve& curve,
                                      double stage_std_mm, double reach_mm);

}  // namespace finray

#endif  // FINRAY_PERCEPTION_BEAM_BOUNDS_H_
