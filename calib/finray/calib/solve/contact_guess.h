#ifndef FINRAY_CALIB_SOLVE_CONTACT_GUESS_H_
#define FINRAY_CALIB_SOLVE_CONTACT_GUESS_H_

#include <Eigen/Core>
#include <memory>

#include "finray/calib/problem/calibration_problem.h"
#include "finray/sensing/fast/contact_fit.h"
#include "finray/sensing/gauge_surface.h"
#include "finray/sensing/gauge_table.h"

namespace finray {

/// Guesses the contact of a frame, for a solve to start from. The finger is
/// that of the present parameters. A measured contact location is taken as it
/// is. Otherwise the contact is searched for, by the place of the object or by
/// the gauges. The search starts from a table of contacts (gauge_table.h).
class ContactGuess {
 public:
  /// Below so many frames, their own equilibria take less time than those of a
  /// surface (load_surface.h).
  static constexpr std::size_t kMany = 2000;

  /// `problem` must stay in place. With `many` frames to guess, a GaugeSurface
  /// fits them. Throws InputError for a finger without an
  /// unloaded equilibrium.
  explicit ContactGuess(CalibrationProblem* problem, bool many = false);

  struct Place {
    double arc_mm = 0, normal_N = 0;
    /// The fit converged, and an object that was fitted alone is met within
    /// 2 mm. If not, the contact is a node of the table or on a bound.
    bool met = false;
  };
  /// kObjectFirst takes a measured force as it is, and uses the gauges only if
  /// the place of the object is not measured. kAll searches by object and
  /// gauges together, for gains that are known.
  enum class From { kObjectFirst, kAll };
  Place Of(const CalibrationFrame& frame, From from);

  const GaugeTable& table() const { return table_; }
  /// Says whether this guess was made for many frames.
  bool many() const { return many_; }

 private:
  void AddCircle(const CalibrationFrame& frame);
  void AddGauges(const CalibrationFrame& frame);
  Place FromTable(bool fit);
  // Moves a start to where it explains the frame best. Returns whether it
  // converges.
  bool Fit(const ContactStart& start, Place* place, double* chi2);

  CalibrationProblem& problem_;
  EquilibriumSolver solver_;
  GaugeTable table_;
  std::shared_ptr<const GaugeSurface> surface_;  // null: none
  ContactFit fit_;
  ContactSolution solution_;
  bool many_, circle_;
  Eigen::VectorXd values_, weights_;  // gauges, then the circle's centre
};

}  // namespace finray

#endif  // FINRAY_CALIB_SOLVE_CONTACT_GUESS_H_
