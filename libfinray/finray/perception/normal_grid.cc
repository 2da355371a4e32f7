#include "finray/perception/normal_grid.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace finray {

namespace {

// The middle of the widest gap between angles; 0 if there are none.
double FarFrom(std::vector<double> angles) {
  if (angles.empty()) return 0;
  for (double& angle : angles) {
    angle -= std::floor(angle / (2 * M_PI)) * 2 * M_PI;
  }
  std::sort(angles.begin(), angles.end());
  double widest = 0, middle = 0;
  for (std::size_t i = 0; i < angles.size(); ++i) {
    const double next =
        i + 1 < angles.size() ? angles[i + 1] : angles[0] + 2 * M_PI;
    if (next - angles[i] <= widest) continue;
    widest = next - angles[i];
    middle = 0.5 * (next + angles[i]);
  }
  return std::fmod(middle, 2 * M_PI);
}

}  // namespace

// Bounds of edge cells first; of the equal cells those that keep clear of them.
NormalGrid::NormalGrid(int cells, const std::vector<double>& edge_angles_rad) {
  const double origin = FarFrom(edge_angles_rad);
  const double half = 0.5 * kEdgeCells * kEdgeCell_rad;
  std::vector<std::pair<double, bool>> starts;  // and whether an edge's
  for (const double angle : edge_angles_rad) {
    const double turns = std::floor((angle - origin) / (2 * M_PI));
    for (int k = 0; k <= kEdgeCells; ++k) {
      starts.emplace_back(angle - turns * 2 * M_PI - half + k * kEdgeCell_rad,
                          k < kEdgeCells);
    }
  }
  for (int j = 0; j < cells; ++j) {
    const double start = origin + 2 * M_PI * j / cells;
    const bool clear = std::none_of(
        edge_angles_rad.begin(), edge_angles_rad.end(), [&](double angle) {
          return std::abs(std::remainder(start - angle, 2 * M_PI)) <
                 half + kEdgeCell_rad / 2;
        });
    if (clear) starts.emplace_back(start, false);
  }
  std::sort(starts.begin(), starts.end());
  bounds_.resize(static_cast<Eigen::Index>(starts.size()) + 1);
  for (std::size_t i = 0; i < starts.size(); ++i) {
    bounds_[static_cast<Eigen::Index>(i)] = starts[i].first;
    edge_.push_back(starts[i].second);
  }
  bounds_[bounds_.size() - 1] = origin + 2 * M_PI;
}

Eigen::Index NormalGrid::CellOf(double angle_rad) const {
  const double* end = bounds_.data() + cells();
  const double* after = std::upper_bound(bounds_.data(), end, angle_rad);
  return std::max<Eigen::Index>(after - bounds_.data() - 1, 0);
}

}  // namespace finray
