#ifndef FINRAY_PERCEPTION_EDGE_CELLS_H_
#define FINRAY_PERCEPTION_EDGE_CELLS_H_

#include <vector>

#include "finray/perception/straight_edges.h"

namespace finray {

/// The outline on a grid with cells for its edges: their lengths go there.
ConvexCurve WithEdges(const ConvexCurve& curve,
                      const std::vector<StraightEdge>& edges, int cells);

/// The edge as a fit on such a grid has it: its cells' length and mean normal.
StraightEdge Settled(StraightEdge edge, const ConvexCurve& curve);

/// Whether each touch lies along one of the edges.
std::vector<bool> Along(const std::vector<Touch>& touches,
                        const std::vector<StraightEdge>& edges,
                        const ConvexCurve& curve);

}  // namespace finray

#endif  // FINRAY_PERCEPTION_EDGE_CELLS_H_
