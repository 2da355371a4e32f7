#ifndef FINRAY_CALIB_SOLVE_CONTACT_GUESS_H_
#define FINRAY_CALIB_SOLVE_CONTACT_GUESS_H_

#include <Eigen/Core>

#include "finray/calib/problem/calibration_problem.h"
#include "finray/sensing/fast/contact_fit.h"
#include "finray/sensing/gauge_table.h"

namespace finray {

/// Where a frame's contact is according to the finger as the parameters
/// describe it now, for a solve to start from: from the object's place, else
/// from the gauges, by a table that knows it to a few bays (gauge_table.h); a
/// contact location and a force that were measured themselves come first.
class ContactGuess {
 public:
  /// `problem` must stay in place. Throws InputError for a finger without an
  /// unloaded equilibrium.
  explicit ContactGuess(CalibrationProblem* problem);

  struct Place {
    double arc_mm = 0, normal_N = 0;
    bool met = false;  ///< what it was looked for by is met, not only near
  };
  /// Whether gauges count beside the object's place: once their gains are
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
