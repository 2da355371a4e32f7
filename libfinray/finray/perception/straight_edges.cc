#include "finray/perception/straight_edges.h"

#include <algorithm>
#include <cmath>

namespace finray {
namespace {

using Eigen::Index;
using Eigen::Vector2d;

constexpr double kNearEnd = 0.12;  // of an edge's length
constexpr double kSagReach_mm = 10;

// From the sag of the beam about the contact.
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
  Index first = 0;  // behind which stretches are counted
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

bool LiesAlong(const Touch& touch, const StraightEdge& edge,
               const ConvexCurve& curve) {
  const Vector2d from = curve.At(edge.from_rad);
  const Vector2d span = curve.At(edge.to_rad) - from;
  const double share = span.dot(touch.point_mm - from) / span.squaredNorm();
  const double off = std::remainder(
      touch.normal_angle_rad - 0.5 * (edge.from_rad + edge.to_rad), 2 * M_PI);
  // About the edge's own side of the object.
  return std::abs(off) < M_PI / 4 && share > kNearEnd && share < 1 - kNearEnd;
}

}  // namespace finray
