#ifndef FINRAY_CALIB_SOLVE_CONTACT_GUESS_H_
#define FINRAY_CALIB_SOLVE_CONTACT_GUESS_H_

#include <Eigen/Core>

#include "finray/calib/problem/calibration_problem.h"
#include "finray/sensing/fast/contact_fit.h"
#include "finray/sensing/gauge_table.h"

namespace finray {

/// Guesses a frame's contact for a solve to start from, by the finger that the
/// parameters describe now. A measured contact location and force come first,
/// then the object's place, then the gauges; a table of contacts
/// (gauge_table.h) has the start of that search.
class ContactGuess {
 public:
  /// `problem` must stay in place. Throws InputError for a finger without an
  /// unloaded equilibrium.
  explicit ContactGuess(CalibrationProblem* problem);

  struct Place {
    double arc_mm = 0, normal_N = 0;
    bool met = false;  ///< what it was looked for by is met, not only near
  };
  /// kAll takes the gauges beside the object's place, for gains that are
  /// known.
  enum class From { kObjectFirst, kAll };
  Place Of(const CalibrationFrame& frame, From from);

  const GaugeTable& table() const { return table_; }

 private:
  ContactGuess(CalibrationProblem* problem, const Finger& finger);
  void AddCircle(const CalibrationFrame& frame);
  void AddGauges(const CalibrationFrame& frame);
  Place FromTable(bool fit);

  CalibrationProblem& problem_;
  EquilibriumSolver solver_;
  GaugeTable table_;
  ContactFit fit_;
  bool circle_;
  Eigen::VectorXd values_, weights_;  // gauges, then the circle's centre
};

}  // namespace finray

#endif  // FINRAY_CALIB_SOLVE_CONTACT_GUESS_H_
