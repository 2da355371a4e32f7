#ifndef FINRAY_SENSING_GAUGE_TABLE_H_
#define FINRAY_SENSING_GAUGE_TABLE_H_

#include <Eigen/Core>
#include <limits>
#include <optional>
#include <vector>

#include "finray/sensing/contact_start.h"
#include "finray/statics/equilibrium.h"

namespace finray {

/// What would be measured, over a coarse grid of one contact's l_c and f_c,
/// with the equilibria: a frame's estimate is started from it without a guess.
/// Built once for a finger.
///
/// Between forces the values are cubics (Hermite's), so that a start's chi2 is
/// that of its row to a small part of a usual std; a chord would leave 10 std.
///
/// Measured values are the gauges' angles in rad and, if the object is a
/// measured circle, its centre (x, y) in mm behind them (circle_centre.h).
class GaugeTable {
 public:
  static constexpr int kMostRows = 56;
  /// Equilibria are as exact as the solver's tolerance, contacts `rows` places
  /// from base to tip, at most kMostRows. Built by so many threads, whose
  /// number does not change it.
  GaugeTable(EquilibriumSolver* solver, double friction,
             std::optional<double> circle_radius_mm, int threads = 1,
             int rows = kMostRows);

  /// The local minima over l_c of the misfit to `values`, whitened by `weights`
  /// (0: not measured), best first; f_c is interpolated.
  void FindStarts(const Eigen::VectorXd& values, const Eigen::VectorXd& weights,
                  std::vector<ContactStart>* starts) const;

  /// The best of them, to a row's spacing, in less time; `state` is null if
  /// there is none.
  ContactStart BestStart(const Eigen::VectorXd& values,
                         const Eigen::VectorXd& weights) const;

  /// An equilibrium of the grid near that under one contact.
  const LadderState& StateNear(double arc_mm, double normal_N) const;

  /// The heaviest force of the grid, 40 EI / l_0^2.
  double heaviest_N() const { return heaviest_N_; }

  struct Node {
    double normal_N;
    Eigen::VectorXd values;
    Eigen::VectorXd by_force;  ///< Slope of the values, per N, from neighbours.
    LadderState state;
  };
  struct Row {
    double arc_mm;
    std::vector<Node> nodes;  ///< Rising force, the first one without load.
    Eigen::ArrayXXd values;   ///< The nodes' again, nodes x values.
  };
  /// Base to tip.
  const std::vector<Row>& rows() const { return rows_; }
  double row_spacing_mm() const { return row_spacing_mm_; }

  /// Angles of the finger under no load.
  const Eigen::VectorXd& free_angles() const { return free_angles_; }

 private:
  struct OnChord {
    double chi2 = std::numeric_limits<double>::infinity();
    std::size_t to = 0;  // the node at its end; 0: none
    double share = 0;    // of the way there
  };
  OnChord NearestChord(const Row& row, const Eigen::VectorXd& values,
                       const Eigen::VectorXd& weights) const;
  ContactStart Refined(const Row& row, const OnChord& chord,
                       const Eigen::VectorXd& values,
                       const Eigen::VectorXd& weights) const;

  double friction_;
  double heaviest_N_, row_spacing_mm_;
  Eigen::VectorXd free_angles_;
  std::vector<Row> rows_;
};

}  // namespace finray

#endif  // FINRAY_SENSING_GAUGE_TABLE_H_
