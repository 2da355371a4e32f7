#ifndef FINRAY_SENSING_SENSITIVITY_TABLE_H_
#define FINRAY_SENSING_SENSITIVITY_TABLE_H_

#include <Eigen/Core>
#include <vector>

#include "finray/statics/equilibrium.h"

namespace finray {

/// Derivatives of the gauge angles s by one contact and by the parameters of
/// the statics, over a grid of l_c and f_c:
///
///   ds/dl_c, f_c ds/df_c, ds/dEI_front, ds/dEI_back, ds/d(rib lengths).
///
/// Between nodes they are polynomials of fifth degree in l_c and in f_c. They
/// are smooth in l_c but for ribs, ends of gauges and of stiffness pieces on
/// the front beam, so there the grid has lines, and no polynomial reaches
/// across. By ln f_c, as then all columns are in proportion to f_c near 0, and
/// as relations that hold at the nodes (all stiffnesses and the force scale
/// together) hold between them.
class SensitivityTable {
 public:
  /// With `friction` at the contact. The solver is left as after Reset().
  SensitivityTable(double friction, EquilibriumSolver* solver);

  /// Fills `derivatives`, gauges x columns() of the size above. False off the
  /// grid: beyond 40 EI / l_0^2, or where the finger folds over before.
  bool Interpolate(double arc_mm, double normal_N,
                   Eigen::MatrixXd* derivatives) const;

  int columns() const { return columns_; }

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

  void AddRow(double arc_mm, double friction, EquilibriumSolver* solver);

  int columns_;
  std::vector<double> forces_N_;
  std::vector<Row> rows_;
  std::vector<Segment> segments_;
  Eigen::MatrixXd
      values_;  // a column a node: the derivatives, column by column
};

}  // namespace finray

#endif  // FINRAY_SENSING_SENSITIVITY_TABLE_H_
