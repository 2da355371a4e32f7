#ifndef FINRAY_SENSING_GAUGE_SURFACE_H_
#define FINRAY_SENSING_GAUGE_SURFACE_H_

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "finray/fit/contact_step.h"
#include "finray/sensing/contact_solution.h"
#include "finray/statics/load_surface.h"

namespace finray {

/// The measured values s_j of all equilibria with one contact, as functions of
/// its (l_c, f_c): the gauges' angles in rad and, if the object is a measured
/// circle, its centre (x, y) in mm behind them (circle_centre.h). Poses and rib
/// tensions follow. The values are those of the statics to a small part of the
/// gauges' noise (load_surface.h), so that a frame is fitted without solving an
/// equilibrium.
class GaugeSurface {
 public:
  /// How exact the surface of an estimate is, in std: it serves a frame whose
  /// measurements are off by no more.
  static constexpr double kEstimate_std = 1e-5;

  /// `solver` is copied when cells are made. Forces go up to `heaviest_N`.
  /// Cells leave out a tenth of `exact_std`, in std of the finger's gauges and
  /// of a circle measured to a micrometre.
  GaugeSurface(const EquilibriumSolver& solver, double friction,
               std::optional<double> circle_radius_mm, double heaviest_N,
               double exact_std = kEstimate_std);

  /// Minimises
  ///
  ///   chi2(l_c, f_c) = sum_j w_j^2 (s_j(l_c, f_c) - values_j)^2
  ///
  /// within 0 <= l_c <= l_0 and 0 <= f_c <= `most_force_N`, by Newton's method
  /// from `start`, to rounding. `weights` are 1 / std, 0 where nothing was
  /// measured. Returns false and leaves `*solution` undefined if the way leads
  /// off the surface or does not end soon, or if the surface is not exact to a
  /// small part of these std. A call for a finger of up to 16 gauges and 26
  /// ribs allocates nothing once `*solution` has been used.
  bool Fit(const Eigen::Ref<const Eigen::VectorXd>& values,
           const Eigen::Ref<const Eigen::VectorXd>& weights,
           double most_force_N, const PointContact& start,
           ContactSolution* solution) const;

  /// Finds s_j under a load. Returns false off the surface.
  bool ValuesAt(double arc_mm, double normal_N, Eigen::VectorXd* values) const;

 private:
  class Descent;
  template <int kOnStack>
  class Scratch;
  // Sets poses and tensions at the contact. Returns false if the surface is
  // wrong by more there, in units of its resolution.
  bool SetOutputs(double most_error, ContactSolution* solution) const;

  double friction_, length_mm_, force_unit_N_, exact_std_;
  int gauges_, values_, ribs_;
  Eigen::VectorXd resolution_;
  LoadSurface surface_;
};

}  // namespace finray

#endif  // FINRAY_SENSING_GAUGE_SURFACE_H_
