#include "finray/perception/outline_cost.h"

#include <cmath>
#include <limits>

namespace finray {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;

// Small, because the lengths of an edge's cells together set its direction.
constexpr double kEdgeLink = 0.01;

// Closer to the contact, along the tangent, the beam says nothing new.
constexpr double kNearContact_mm = 2;
// Largest angle between the normals of the contact and of a point at its beam.
constexpr double kSector_rad = 1.2;
// A point farther beyond the beam lies on another side of the object.
constexpr double kDeepest_mm = 10;
constexpr double kNear = 3;  // std

struct Nearest {
  Vector2d point, normal;
  double beyond_mm = -std::numeric_limits<double>::infinity();
};

// The foot of the shortest perpendicular to a polyline, which runs from base to
// tip with the finger on its right.
Nearest NearestOf(const std::vector<Vector2d>& beam, const Vector2d& point) {
  Nearest nearest;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i + 1 < beam.size(); ++i) {
    const Vector2d span = beam[i + 1] - beam[i];
    const double length = span.norm();
    const double along = span.dot(point - beam[i]) / length;
    if (along < 0 || along > length) continue;
    const Vector2d normal(span.y() / length, -span.x() / length);
    const double beyond = normal.dot(point - beam[i]);
    if (std::abs(beyond) >= least) continue;
    least = std::abs(beyond);
    nearest = {beam[i] + along / length * span, normal, beyond};
  }
  return nearest;
}

}  // namespace

OutlineCost::OutlineCost(const Vector2d& point_mm, double normal_angle_rad,
                         const Whitening& whitening, bool one_sided,
                         const NormalGrid& grid)
    : offset_(whitening * point_mm),
      rows_(whitening.rows(), grid.cells() + 2),
      one_sided_(one_sided) {
  rows_ << whitening * ConvexCurve::SlopeAt(normal_angle_rad, grid), whitening;
  set_num_residuals(static_cast<int>(rows_.rows()));
  mutable_parameter_block_sizes()->assign({static_cast<int>(rows_.cols())});
}

OutlineCost::OutlineCost(const NormalGrid& grid, double std_mm)
    : OutlineCost({0, 0}, std::nextafter(grid.origin_rad() + 2 * M_PI, 0),
                  Eigen::Matrix2d::Identity() / std_mm, false, grid) {
  rows_.rightCols<2>().setZero();
}

bool OutlineCost::Evaluate(double const* const* parameters, double* residuals,
                           double** jacobians) const {
  const Index cells = rows_.cols() - 2;
  VectorXd factors = Eigen::Map<const VectorXd>(parameters[0], cells + 2);
  factors.head(cells) = factors.head(cells).array().exp();
  Eigen::Map<VectorXd> residual(residuals, rows_.rows());
  residual = offset_ - rows_ * factors;
  const bool idle = one_sided_ && residual[0] > 0;
  if (idle) residual.setZero();
  if (jacobians != nullptr && jacobians[0] != nullptr) {
    factors.tail<2>().setOnes();
    Eigen::Map<
        Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(
        jacobians[0], rows_.rows(), rows_.cols()) =
        (idle ? 0 : -1) * rows_ * factors.asDiagonal();
  }
  return residual.allFinite();
}

MatrixXd RoughnessMatrix(const NormalGrid& grid) {
  const Index cells = grid.cells();
  const auto middle = [&](Index cell) {
    return grid.Start(cell) + 0.5 * grid.Width(cell);
  };
  MatrixXd rows = MatrixXd::Zero(cells, cells);
  Index count = 0;
  const auto link = [&](Index from, Index to, double weight) {
    rows(count, from) = -weight;
    rows(count++, to) = weight;
  };
  // The last cell belongs to no edge: the origin is far from all edges.
  Index before = cells - 1;
  for (Index j = 0; j < cells; ++j) {
    if (grid.IsEdge(j)) {
      if (grid.IsEdge(j + 1)) link(j, j + 1, kEdgeLink);
      continue;
    }
    double distance = middle(j) - middle(before);
    if (distance <= 0) distance += 2 * M_PI;
    link(before, j, 1 / std::sqrt(distance));
    before = j;
  }
  return rows.topRows(count);
}

std::vector<BeamBound> FindBeamBounds(const std::vector<Touch>& touches,
                                      const ConvexCurve& curve,
                                      double stage_std_mm, double reach_mm) {
  std::vector<BeamBound> bounds;
  const NormalGrid& grid = curve.grid();
  std::vector<Vector2d> points;
  for (Eigen::Index j = 0; j < grid.cells(); ++j) {
    points.push_back(curve.At(grid.Start(j)));
  }
  for (const Touch& touch : touches) {
    const std::vector<Vector2d> beam = touch.BeamNear(reach_mm);
    const Vector2d normal = touch.Normal();
    const Vector2d tangent(-normal.y(), normal.x());
    const double normal_variance =
        normal.dot(touch.covariance.topLeftCorner<2, 2>() * normal) +
        stage_std_mm * stage_std_mm;
    for (std::size_t j = 0; j < points.size(); ++j) {
      const double angle = grid.Start(static_cast<Eigen::Index>(j));
      if (std::abs(std::remainder(angle - touch.normal_angle_rad, 2 * M_PI)) >
          kSector_rad) {
        continue;
      }
      const double aside = tangent.dot(points[j] - touch.point_mm);
      if (std::abs(aside) < kNearContact_mm) continue;
      const double std_mm =
          std::sqrt(normal_variance + aside * aside * touch.covariance(2, 2));
      const Nearest nearest = NearestOf(beam, points[j]);
      if (nearest.beyond_mm < -kNear * std_mm ||
          nearest.beyond_mm > kDeepest_mm) {
        continue;
      }
      bounds.push_back({angle, nearest.point, nearest.normal, std_mm});
    }
  }
  return bounds;
}

}  // namespace finray
