#ifndef FINRAY_SENSING_GAUGE_SURFACE_H_
#define FINRAY_SENSING_GAUGE_SURFACE_H_

#include <Eigen/Core>
#include <vector>

#include "finray/sensing/contact_solution.h"
#include "finray/sensing/fast/contact_step.h"
#include "finray/sensing/gauge_table.h"

namespace finray {

/// The values of a GaugeTable between its rows and forces: bicubic Hermite
/// polynomials s_j(x) of x = (l_c / l_0, f_c / (EI / l_0^2)), with slopes from
/// the neighbours of each node. Its first row is the clamp, where no contact
/// bends the finger, its last row the tip. The error is a small part of a
/// typical std up to 8 N for the paper's finger. A descent on them takes less
/// time than one iteration of a fit, and a fit that starts from its end needs
/// few iterations.
class GaugeSurface {
 public:
  /// Keeps no reference to the table. The surface ends at the force that all
  /// rows have.
  GaugeSurface(const GaugeTable& table, const Finger& finger);

  /// Minimises chi2 = sum_j w_j^2 (s_j(x) - values_j)^2 from the contact of
  /// `start`, within 0 <= l_c <= l_0 and 0 <= f_c <= `most_force_N`. Sets
  /// contact and chi2 of `start` to those of the minimum. Returns false and
  /// leaves it alone if the way leads off the surface or does not end soon.
  bool Descend(const Eigen::VectorXd& values, const Eigen::VectorXd& weights,
               double most_force_N, ContactStart* start) const;

  /// s_j and its derivatives by x.
  struct Value {
    double value, by_arc, by_force, by_arc_arc, by_arc_force, by_force_force;
  };
  /// `arc` and `force` are those of x. Requires Covers(force).
  Value At(Eigen::Index j, double arc, double force) const;
  /// d2 s_j / dx2 of all s_j. Requires Covers(force).
  void CurvaturesAt(double arc, double force, GaugeCurvatures* second) const;
  bool Covers(double force) const {
    return !forces_.empty() && force <= forces_.back();
  }

 private:
  // s, its slopes by l and f, and its twist at a node
  struct Corner {
    double value, by_arc, by_force, by_both;
  };
  struct Cubics;
  struct Cell;
  Cell CellAt(double arc, double force) const;
  ContactEquations EquationsAt(const ContactVector& x,
                               const Eigen::VectorXd& values,
                               const Eigen::VectorXd& weights) const;
  void SetSlopes();

  double length_mm_, force_unit_N_;
  std::size_t values_ = 0;
  std::vector<double> arcs_, forces_;  // of x
  std::vector<Corner> corners_;        // rows x forces x values
};

}  // namespace finray

#endif  // FINRAY_SENSING_GAUGE_SURFACE_H_
