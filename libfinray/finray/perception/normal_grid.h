#ifndef FINRAY_PERCEPTION_NORMAL_GRID_H_
#define FINRAY_PERCEPTION_NORMAL_GRID_H_

#include <Eigen/Core>
#include <vector>

namespace finray {

/// Cells of the angle of an outline's normal, once around from an origin that
/// is far from edges: equal ones, and in the place of a straight edge a few
/// narrow ones that may hold its length.
class NormalGrid {
 public:
  static constexpr int kEdgeCells = 3;
  static constexpr double kEdgeCell_rad = 0.003;

  explicit NormalGrid(int cells,
                      const std::vector<double>& edge_angles_rad = {});

  Eigen::Index cells() const { return bounds_.size() - 1; }
  double Start(Eigen::Index cell) const { return bounds_[cell]; }
  double Width(Eigen::Index cell) const {
    return bounds_[cell + 1] - bounds_[cell];
  }
  double origin_rad() const { return bounds_[0]; }
  /// The cell of an angle from the origin up to a turn beyond.
  Eigen::Index CellOf(double angle_rad) const;
  /// Whether it belongs to a straight edge.
  bool IsEdge(Eigen::Index cell) const {
    return edge_[static_cast<std::size_t>(cell)];
  }

 private:
  Eigen::VectorXd bounds_;
  std::vector<bool> edge_;
};

}  // namespace finray

#endif  // FINRAY_PERCEPTION_NORMAL_GRID_H_
