#ifndef FINRAY_PERCEPTION_BEAM_BOUND_H_
#define FINRAY_PERCEPTION_BEAM_BOUND_H_

#include <Eigen/Core>
#include <vector>

#include "finray/perception/contact_sensor.h"
#include "finray/perception/convex_curve.h"

namespace finray {

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

#endif  // FINRAY_PERCEPTION_BEAM_BOUND_H_
