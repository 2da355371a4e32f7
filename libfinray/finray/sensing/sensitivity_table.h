#ifndef FINRAY_SENSING_SENSITIVITY_TABLE_H_
#define FINRAY_SENSING_SENSITIVITY_TABLE_H_

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "finray/statics/equilibrium.h"

namespace finray {

/// Reads the derivatives of a frame's measured values after the solver's
/// SolveWithSensitivities(contacts). The rows are the gauge angles and, with
/// `circle_radius_mm`, the centre of a circle at the one contact
/// (circle_centre.h). The columns are
///
///   l_c, ln f_c of each contact, EI front, EI back, rib lengths, effects of
///   the solver's model and friction if it is carried,
///
/// and with `gauge_places` two more: for each gauge the derivatives by its own
/// start and length, d(angle)/d(start) = kappa(end) - kappa(start) and
/// d(angle)/d(length) = kappa(end).
///
/// Derivatives are by ln f_c because all gauge rows are then proportional to
/// f_c near 0.
void ReadSensitivities(const EquilibriumSolver& solver,
                       const std::vector<PointContact>& contacts,
                       std::optional<double> circle_radius_mm,
                       bool gauge_places, Eigen::MatrixXd* derivatives);

/// The same derivatives for one contact, from a grid over l_c and f_c with
/// polynomials of degree five between its nodes. The derivatives are smooth in
/// l_c except at ribs, gauge ends and ends of stiffness pieces on the front
/// beam. The grid has lines at these places, and no polynomial crosses them. A
/// linear relation that holds at the nodes also holds between them, for example
/// that all stiffnesses and the force scale together.
class SensitivityTable {
 public:
  /// Builds the table for contacts with `friction`. `solver` is then as after
  /// Reset().
  SensitivityTable(double friction, std::optional<double> circle_radius_mm,
                   EquilibriumSolver* solver, bool gauge_places = false);

  /// Fills `derivatives`, rows() x columns(). Returns false outside the grid:
  /// beyond 40 EI / l_0^2, or where the finger folds over before.
  bool Interpolate(double arc_mm, double normal_N,
                   Eigen::MatrixXd* derivatives) const;

  int rows() const { return static_cast<int>(node_.rows()); }
  int columns() const { return static_cast<int>(node_.cols()); }

 private:
  // Nodes of one l_c by rising force. They are columns of values_ from `first`
  // on.
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

  bool gauge_places_;
  Eigen::MatrixXd node_;  // the derivatives at the last node computed
  std::vector<double> forces_N_;
  std::vector<Row> rows_;
  std::vector<Segment> segments_;
  Eigen::MatrixXd
      values_;  // one column per node: its derivatives, column by column
};

}  // namespace finray

#endif  // FINRAY_SENSING_SENSITIVITY_TABLE_H_
