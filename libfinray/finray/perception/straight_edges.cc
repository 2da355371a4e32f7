#include "finray/perception/straight_edges.h"

#include <algorithm>
#include <cmath>

namespace finray {
namespace {

using Eigen::Index;
using Eigen::Vector2d;

constexpr double kNearEnd = 0.12;  // of an edge's length
constexpr double kSagReach_mm = 10;
// Ordinary cells within an edge start with the radius that is found this far
// beside it.
constexpr double kBeside_rad = 0.03;

// The curvature of the beam from its sag about the contact.
double BeamCurvature(const Touch& touch) {
  const std::vector<Vector2d> beam = touch.BeamNear(kSagReach_mm);
  const Vector2d chord = beam.back() - beam.front();
  const Vector2d middle = beam[beam.size() / 2] - beam.front();
  const double sag =
      (chord.y() * middle.x() - chord.x() * middle.y()) / chord.norm();
  return 8 * sag / chord.squaredNorm();
}

double MedianBeamCurvature(const std::vector<Touch>& touches) {
  std::vector<double> curvatures;
  for (const Touch& touch : touches) {
    curvatures.push_back(BeamCurvature(touch));
  }
  const auto middle =
      curvatures.begin() + static_cast<std::ptrdiff_t>(curvatures.size() / 2);
  std::nth_element(curvatures.begin(), middle, curvatures.end());
  return *middle;
}

double RadiusOf(const ConvexCurve& curve, double normal_angle_rad) {
  const double from = normal_angle_rad - curve.grid().origin_rad();
  const double turns = std::floor(from / (2 * M_PI));
  return curve
      .radii_mm()[curve.grid().CellOf(normal_angle_rad - turns * 2 * M_PI)];
}

// Whether a touch lies along an edge and not at one of its ends.
bool LiesAlong(const Touch& touch, const StraightEdge& edge,
               const ConvexCurve& curve) {
  const Vector2d from = curve.At(edge.from_rad);
  const Vector2d span = curve.At(edge.to_rad) - from;
  const double share = span.dot(touch.point_mm - from) / span.squaredNorm();
  const double off = std::remainder(
      touch.normal_angle_rad - 0.5 * (edge.from_rad + edge.to_rad), 2 * M_PI);
  // Another side of the object may be parallel.
  return std::abs(off) < M_PI / 4 && share > kNearEnd && share < 1 - kNearEnd;
}

}  // namespace

std::vector<StraightEdge> FindStraightEdges(const ConvexCurve& curve,
                                            const std::vector<Touch>& touches) {
  const NormalGrid& grid = curve.grid();
  const Index cells = grid.cells();
  const double curvature = MedianBeamCurvature(touches);
  std::vector<StraightEdge> edges;
  if (!(curvature > 0)) return edges;
  const auto flat = [&](Index j) {
    return curve.radii_mm()[j % cells] > kFlat / curvature;
  };
  Index first = 0;  // the search starts outside any stretch
  while (first < cells && flat(first)) ++first;
  for (Index j = first; j < first + cells; ++j) {
    if (!flat(j)) continue;
    const auto start = [&](Index cell) {
      return grid.Start(cell % cells) + (cell >= cells ? 2 * M_PI : 0);
    };
    StraightEdge edge{start(j), 0, 0, 0};
    for (; j < first + cells && flat(j); ++j) {
      const double width = grid.Width(j % cells);
      edge.length_mm += curve.radii_mm()[j % cells] * width;
      edge.to_rad = start(j) + width;
    }
    const Vector2d chord = curve.At(edge.to_rad) - curve.At(edge.from_rad);
    edge.middle_rad = std::atan2(-chord.x(), chord.y());
    const bool flatter =
        edge.length_mm / (edge.to_rad - edge.from_rad) > kAlong / curvature;
    if (edge.length_mm < kShortestEdge * curve.perimeter_mm() / (2 * M_PI) ||
        (!flatter &&
         std::any_of(touches.begin(), touches.end(), [&](const Touch& touch) {
           return LiesAlong(touch, edge, curve);
         }))) {
      continue;
    }
    edges.push_back(edge);
  }
  return edges;
}

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
