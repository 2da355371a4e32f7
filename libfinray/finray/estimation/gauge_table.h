#ifndef FINRAY_ESTIMATION_GAUGE_TABLE_H_
#define FINRAY_ESTIMATION_GAUGE_TABLE_H_

#include <Eigen/Core>
#include <limits>
#include <optional>
#include <vector>

#include "finray/estimation/contact_solution.h"
#include "finray/estimation/row_boxes.h"
#include "finray/statics/equilibrium.h"

namespace finray {

/// A coarse grid over l_c and f_c of one contact, with the values that would be
/// measured and the equilibrium at each node. A frame's estimate starts from
/// this table without a guess. It is built once for a finger.
///
/// Between forces the table interpolates values by cubic Hermite polynomials. A
/// start's chi2 then deviates from that of its row by a small part of a typical
/// std; a linear interpolation would deviate by 10 std.
///
/// The values are the gauges' angles in rad. If the object is a measured
/// circle, its centre (x, y) in mm follows them (circle_centre.h).
class GaugeTable {
 public:
  static constexpr int kMostRows = 56;
  /// A profile with this bound has all rows.
  static constexpr double kAnyChi2 = std::numeric_limits<double>::infinity();

  /// Builds the table with contacts at `rows` places from base to tip, at most
  /// kMostRows, and forces up to most_force_N or 40 EI / l_0^2, on `threads`
  /// threads. The equilibria are as exact as the solver's tolerance. The result
  /// does not depend on `threads`.
  GaugeTable(EquilibriumSolver* solver, double friction,
             std::optional<double> circle_radius_mm,
             std::optional<double> most_force_N = {}, int threads = 1,
             int rows = kMostRows);

  /// Finds the best contact of each row, from base to tip. `weights` whiten the
  /// misfit to `values` (0: not measured; the value is finite even so). f_c is
  /// interpolated. A row without
  /// load has an infinite chi2 and no contact. A row whose chi2 is `most_chi2`
  /// or more may get a larger one, or look like one without load.
  ///
  /// Contacts nearer to such a row than to others have a chi2 of `most_chi2` or
  /// more, too, as far as RowBoxes hold.
  void Profile(const Eigen::VectorXd& values, const Eigen::VectorXd& weights,
               double most_chi2, std::vector<ContactStart>* profile) const;

  /// Finds the local minima of a profile, between rows, best first.
  static void FindStarts(const std::vector<ContactStart>& profile,
                         std::vector<ContactStart>* starts);

  /// The best row of the profile. Its `state` is null if there is none.
  ContactStart BestStart(const Eigen::VectorXd& values,
                         const Eigen::VectorXd& weights) const;

  /// The equilibrium of the grid node near that contact.
  const LadderState& StateNear(double arc_mm, double normal_N) const;

  /// The largest force of the grid where nobody says most_force_N: 40 EI /
  /// l_0^2.
  static double HeaviestForce_N(const Finger& finger);

  /// The largest force of the grid.
  double heaviest_N() const { return heaviest_N_; }

  /// The friction coefficient of all its contacts.
  double friction() const { return friction_; }

  struct Node {
    double normal_N;
    Eigen::VectorXd values;
    Eigen::VectorXd by_force;  ///< Slope of the values per N, from neighbours.
    LadderState state;
  };
  struct Row {
    double arc_mm;
    std::vector<Node> nodes;  ///< By rising force; the first has no load.
  };
  /// Rows from base to tip.
  const std::vector<Row>& rows() const { return rows_; }
  double row_spacing_mm() const { return row_spacing_mm_; }

  /// Gauge angles of the unloaded finger.
  const Eigen::VectorXd& free_angles() const { return free_angles_; }

 private:
  void FindErrors(EquilibriumSolver* solver,
                  const std::optional<double>& circle_radius_mm);
  void FillCurves();
  RowCurves Curves() const;
  // Calls use(row, chi2, to, share) for the best force of each row.
  template <class Use>
  void ForEachRow(const Eigen::VectorXd& values, const Eigen::VectorXd& weights,
                  double most_chi2, const Use& use) const;
  void SetStart(std::size_t row, int to, double share, double chi2,
                ContactStart* start) const;

  double friction_;
  double heaviest_N_, row_spacing_mm_;
  Eigen::VectorXd free_angles_;
  std::vector<Row> rows_;
  Eigen::ArrayXXd errors_;  // of interpolated values, values x chords
  std::vector<double> forces_N_;
  std::vector<double> value_, by_force_;  // of RowCurves
  RowBoxes boxes_;
};

}  // namespace finray

#endif  // FINRAY_ESTIMATION_GAUGE_TABLE_H_
