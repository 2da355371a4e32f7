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

// The median curvature of the beams, each from its sag about the contact.
double MedianBeamCurvature(const std::vector<Touch>& touches) {
  std::vector<double> curvatures;
  for (const Touch& touch : touches) {
    const std::vector<Vector2d> beam = touch.BeamNear(kSagReach_mm);
    const Vector2d chord = beam.back() - beam.front();
    const Vector2d middle = beam[beam.size() / 2] - beam.front();
    const double sag =
        (chord.y() * middle.x() - chord.x() * middle.y()) / chord.norm();
    curvatures.push_back(8 * sag / chord.squaredNorm());
  }
  const auto middle =
      curvatures.begin() + static_cast<std::ptrdiff_t>(curvatures.size() / 2);
  std::nth_element(curvatures.begin(), middle, curvatures.end());
  return *middle;
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
                      const std::vector<StraightEdge>& edges) {
  if (edges.empty()) return curve;
  std::vector<double> angles;
  for (const StraightEdge& edge : edges) angles.push_back(edge.middle_rad);
  const NormalGrid grid(kOutlineCells, angles);
  Eigen::VectorXd radii(grid.cells());
  for (Index j = 0; j < grid.cells(); ++j) {
    const double middle = grid.Middle(j);
    radii[j] = curve.RadiusAt(middle);
    for (const StraightEdge& edge : edges) {
      const double off = middle - 0.5 * (edge.from_rad + edge.to_rad);
      if (std::abs(std::remainder(off, 2 * M_PI)) >
          0.5 * (edge.to_rad - edge.from_rad)) {
        continue;
      }
      radii[j] = grid.IsEdge(j) ? edge.length_mm / (NormalGrid::kEdgeCells *
                                                    NormalGrid::kEdgeCell_rad)
                                : curve.RadiusAt(edge.from_rad - kBeside_rad);
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

void Settle(const ConvexCurve& curve, std::vector<StraightEdge>* edges) {
  const NormalGrid& grid = curve.grid();
  for (StraightEdge& edge : *edges) {
    double length = 0, moment = 0;
    for (Index j = 0; j < grid.cells(); ++j) {
      const double off =
          std::remainder(grid.Middle(j) - edge.middle_rad, 2 * M_PI);
      if (!grid.IsEdge(j) || std::abs(off) > 3 * NormalGrid::kEdgeCell_rad) {
        continue;
      }
      length += curve.radii_mm()[j] * grid.Width(j);
      moment += curve.radii_mm()[j] * grid.Width(j) * off;
    }
    if (length > 0) edge.middle_rad += moment / length;
    edge.length_mm = length;
  }
}

}  // namespace finray
