#ifndef FINRAY_SENSING_GAUGE_TABLE_H_
#define FINRAY_SENSING_GAUGE_TABLE_H_

#include <Eigen/Core>
#include <vector>

#include "finray/statics/equilibrium.h"

namespace finray {

/// Gauge angles over a coarse grid of one contact's l_c and f_c, with the
/// equilibria, from which a frame's estimate is started without a guess. Built
/// once for a finger.
class GaugeTable {
 public:
  explicit GaugeTable(EquilibriumSolver* solver);

  /// A place to start from: the contact, and the equilibrium nearest to it.
  struct Start {
    double arc_mm;
    double normal_N;
    double cost;  ///< Half the sum of squares of the whitened misfit.
    const LadderState* state;
  };

  /// The local minima over l_c of the misfit to `angles_rad`, whitened by
  /// `weight_per_rad` (0: not measured), best first; f_c is interpolated.
  void FindStarts(const Eigen::VectorXd& angles_rad,
                  const Eigen::VectorXd& weight_per_rad,
                  std::vector<Start>* starts) const;

  /// The heaviest force of the grid, 40 EI / l_0^2.
  double heaviest_N() const { return heaviest_N_; }

  /// Angles of the finger under no load.
  const Eigen::VectorXd& free_angles() const { return free_angles_; }

 private:
  struct Node {
    double normal_N;
    Eigen::VectorXd angles_rad;
    LadderState state;
  };
  struct Row {
    double arc_mm;
    std::vector<Node> nodes;  // rising force
  };

  double heaviest_N_;
  Eigen::VectorXd free_angles_;
  LadderState free_state_;
  std::vector<Row> rows_;
};

}  // namespace finray

#endif  // FINRAY_SENSING_GAUGE_TABLE_H_
