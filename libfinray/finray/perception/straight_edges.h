#ifndef FINRAY_PERCEPTION_STRAIGHT_EDGES_H_
#define FINRAY_PERCEPTION_STRAIGHT_EDGES_H_

#include <vector>

#include "finray/perception/convex_curve.h"
#include "finray/perception/touch.h"

namespace finray {

// Where an outline is about as flat as the beam that touches it, the beam lies
// along it or rests on both ends of an edge, and the gauges hardly tell which:
// one contact in the middle explains readings of two at the ends, at a place
// that is too far out by the beam's sag, L^2 kappa / 8. Such a stretch is drawn
// as a straight edge between its ends, which touches from either side tell.

/// A stretch of the outline from one normal angle to another.
struct StraightEdge {
  double from_rad, to_rad;
  double middle_rad;  ///< normal angle of the chord between its ends
  double length_mm;
};

/// Stretches whose radius of curvature exceeds kFlat of the beam's, and that
/// are longer than kShortestEdge of the mean radius. Touches that lie along one
/// are against it unless its mean radius of curvature exceeds kAlong of the
/// beam's, where they are not to be trusted.
constexpr double kFlat = 0.15;
constexpr double kAlong = 0.4;
constexpr double kShortestEdge = 0.3;
std::vector<StraightEdge> FindStraightEdges(const ConvexCurve& curve,
                                            const std::vector<Touch>& touches);

/// Whether a touch lies along an edge and not at one of its ends.
bool LiesAlong(const Touch& touch, const StraightEdge& edge,
               const ConvexCurve& curve);

}  // namespace finray

#endif  // FINRAY_PERCEPTION_STRAIGHT_EDGES_H_
