#include "finray/perception/normal_grid.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace finray {

// Bounds of edge cells first; of the equal cells those that keep clear of them.
NormalGrid::NormalGrid(int cells, std::vector<double> edge_angles_rad) {
  std::vector<std::pair<double, bool>> starts;  // and whether an edge's
  const double half = 0.5 * kEdgeCells * kEdgeCell_rad;
  for (double& angle : edge_angles_rad) {
    angle -= std::floor(angle / (2 * M_PI)) * 2 * M_PI;
    // It does not pass the angle 0.
    angle = std::clamp(angle, 2 * half, 2 * M_PI - 2 * half);
    for (int k = 0; k <= kEdgeCells; ++k) {
      starts.emplace_back(angle - half + k * kEdgeCell_rad, k < kEdgeCells);
    }
  }
  for (int j = 0; j < cells; ++j) {
    const double start = 2 * M_PI * j / cells;
    const bool clear = std::none_of(
        edge_angles_rad.begin(), edge_angles_rad.end(), [&](double angle) {
          return std::abs(start - angle) < half + kEdgeCell_rad / 2;
        });
    if (clear) starts.emplace_back(start, false);
  }
  std::sort(starts.begin(), starts.end());
  bounds_.resize(static_cast<Eigen::Index>(starts.size()) + 1);
  for (std::size_t i = 0; i < starts.size(); ++i) {
    bounds_[static_cast<Eigen::Index>(i)] = starts[i].first;
    edge_.push_back(starts[i].second);
  }
  bounds_[0] = 0;
  bounds_[bounds_.size() - 1] = 2 * M_PI;
}

Eigen::Index NormalGrid::CellOf(double angle_rad) const {
  const double* end = bounds_.data() + cells();
  const double* after = std::upper_bound(bounds_.data(), end, angle_rad);
  return std::max<Eigen::Index>(after - bounds_.data() - 1, 0);
}

}  // namespace finray
