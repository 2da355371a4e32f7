#include "finray/perception/edge_cells.h"

#include <algorithm>
#include <cmath>

namespace finray {
namespace {

using Eigen::Index;

// Beside an edge, the radius that cells near it start from.
constexpr double kBeside_rad = 0.03;

double RadiusOf(const ConvexCurve& curve, double normal_angle_rad) {
  const double from = normal_angle_rad - curve.grid().origin_rad();
  const double turns = std::floor(from / (2 * M_PI));
  return curve
      .radii_mm()[curve.grid().CellOf(normal_angle_rad - turns * 2 * M_PI)];
}

}  // namespace

ConvexCurve WithEdges(const ConvexCurve& curve,
                      const std::vector<StraightEdge>& edges, int cells) {
  if (edges.empty()) return curve;
  std::vector<double> angles;
  for (const StraightEdge& edge : edges) angles.push_back(edge.middle_rad);
  const NormalGrid grid(cells, angles);
  Eigen::VectorXd radii(grid.cells());
  const auto in = [](double angle, const StraightEdge& edge) {
    const double middle = 0.5 * (edge.from_rad + edge.to_rad);
    return std::abs(std::remainder(angle - middle, 2 * M_PI)) <=
           0.5 * (edge.to_rad - edge.from_rad);
  };
  for (Index j = 0; j < grid.cells(); ++j) {
    const double middle = grid.Start(j) + 0.5 * grid.Width(j);
    radii[j] = RadiusOf(curve, middle);
    for (const StraightEdge& edge : edges) {
      if (!in(middle, edge)) continue;
      radii[j] = grid.IsEdge(j) ? edge.length_mm / (NormalGrid::kEdgeCells *
                                                    NormalGrid::kEdgeCell_rad)
                                : RadiusOf(curve, edge.from_rad - kBeside_rad);
    }
  }
  return {grid, curve.At(grid.origin_rad()), radii};
}

std::vector<bool> Along(const std::vector<Touch>& touches,
                        const std::vector<StraightEdge>& edges,
                        const ConvexCurve& curve) {
  std::vector<bool> along;
  for (const Touch& touch : touches) {
    along.push_back(
        std::any_of(edges.begin(), edges.end(), [&](const StraightEdge& edge) {
          return LiesAlong(touch, edge, curve);
        }));
  }
  return along;
}

StraightEdge Settled(StraightEdge edge, const ConvexCurve& curve) {
  const NormalGrid& grid = curve.grid();
  double length = 0, moment = 0;
  for (Index j = 0; j < grid.cells(); ++j) {
    const double middle = grid.Start(j) + 0.5 * grid.Width(j);
    const double off = std::remainder(middle - edge.middle_rad, 2 * M_PI);
    if (!grid.IsEdge(j) || std::abs(off) > 3 * NormalGrid::kEdgeCell_rad) {
      continue;
    }
    length += curve.radii_mm()[j] * grid.Width(j);
    moment += curve.radii_mm()[j] * grid.Width(j) * off;
  }
  if (length > 0) edge.middle_rad += moment / length;
  edge.length_mm = length;
  return edge;
}

}  // namespace finray
