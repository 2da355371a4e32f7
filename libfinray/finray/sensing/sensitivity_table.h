#ifndef FINRAY_SENSING_SENSITIVITY_TABLE_H_
#define FINRAY_SENSING_SENSITIVITY_TABLE_H_

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "finray/statics/equilibrium.h"

namespace finray {

/// Derivatives of what is measured in a frame, gauge angles and, with
/// `circle_radius_mm`, the centre of a circle at the one contact
/// (circle_centre.h), after a solver's SolveWithSensitivities(contacts).
/// Columns
///
///   l_c, ln f_c of each contact, EI front, EI back, rib lengths;
///
/// by ln f_c, as then all of gauges is in proportion to f_c near 0.
void ReadSensitivities(const EquilibriumSolver& solver,
                       const std::vector<PointContact>& contacts,
                       std::optional<double> circle_radius_mm,
                       Eigen::MatrixXd* derivatives);

/// The same for one contact, from a grid of l_c and f_c with polynomials of
/// fifth degree between its nodes. Derivatives are smooth in l_c but for ribs,
/// ends of gauges and of stiffness pieces on the front beam, so there the grid
/// has lines, and no polynomial reaches across. Linear relations that hold at
/// the nodes, as that all stiffnesses and the force scale together, hold
/// between them.
class SensitivityTable {
 public:
  /// With `friction` at the contact. The solver is left as after Reset().
  SensitivityTable(double friction, std::optional<double> circle_radius_mm,
                   EquilibriumSolver* solver);

  /// Fills `derivatives`, rows() x columns(). False off the grid: beyond
  /// 40 EI / l_0^2, or where the finger folds over before.
  bool Interpolate(double arc_mm, double normal_N,
                   Eigen::MatrixXd* derivatives) const;

  int rows() const { return static_cast<int>(node_.rows()); }
  int columns() const { return static_cast<int>(node_.cols()); }

 private:
  // Nodes of one l_c by rising force, columns of values_ from `first` on.
  struct Row {
    double arc_mm;
    int first, count;
  };
  // Rows between two lines of the grid.
  struct Segment {
    double end_mm;
    int first, count;
  };

  void AddRow(double arc_mm, double friction,
              std::optional<double> circle_radius_mm,
              EquilibriumSolver* solver);

  Eigen::MatrixXd node_;  // the derivatives at the last node made
  std::vector<double> forces_N_;
  std::vector<Row> rows_;
  std::vector<Segment> segments_;
  Eigen::MatrixXd
      values_;  // a column a node: the derivatives, column by column
};

}  // namespace finray

#endif  // FINRAY_SENSING_SENSITIVITY_TABLE_H_
