#ifndef FINRAY_PERCEPTION_STRAIGHT_EDGES_H_
#define FINRAY_PERCEPTION_STRAIGHT_EDGES_H_

#include <vector>

#include "finray/perception/contact_sensor.h"
#include "finray/perception/convex_curve.h"

namespace finray {

// Where an outline is about as flat as the beam that touches it, the beam
// either lies along the outline or rests on both ends of an edge. The gauges
// hardly tell which: one contact in the middle explains the readings of two
// contacts at the ends, but its place is too far out by the beam's sag, L^2
// kappa / 8. Such a stretch becomes a straight edge. Touches on either side
// determine its ends.

constexpr int kOutlineCells = 180;  ///< of the grid of an outline

/// A stretch of the outline from one normal angle to another.
struct StraightEdge {
  double from_rad, to_rad;
  double middle_rad;  ///< normal angle of the chord between its ends
  double length_mm;
};

/// The stretches whose radius of curvature is above kFlat of the beam's and
/// whose length is above kShortestEdge of the mean radius. A touch that lies
/// along a stretch speaks against an edge, unless the stretch's mean radius of
/// curvature is above kAlong of the beam's, where such touches are not
/// reliable.
constexpr double kFlat = 0.15;
constexpr double kAlong = 0.4;
constexpr double kShortestEdge = 0.3;
std::vector<StraightEdge> FindStraightEdges(const ConvexCurve& curve,
                                            const std::vector<Touch>& touches);

/// For each touch, whether it lies along one of the edges and not at its ends.
std::vector<bool> Along(const std::vector<Touch>& touches,
                        const std::vector<StraightEdge>& edges,
                        const ConvexCurve& curve);

/// The outline on a grid in which narrow cells hold the lengths of the edges.
ConvexCurve WithEdges(const ConvexCurve& curve,
                      const std::vector<StraightEdge>& edges);

/// Gives each edge the length and the mean normal that its cells have in a fit.
void Settle(const ConvexCurve& curve, std::vector<StraightEdge>* edges);

}  // namespace finray

#endif  // FINRAY_PERCEPTION_STRAIGHT_EDGES_H_
