#ifndef FINRAY_CALIB_SOLVE_CONTACT_GUESS_H_
#define FINRAY_CALIB_SOLVE_CONTACT_GUESS_H_

#include <Eigen/Core>
#include <memory>

#include "finray/calib/problem/calibration_problem.h"
#include "finray/calib/solve/frame_linearizer.h"
#include "finray/estimation/gauge_table.h"

namespace finray {

/// Guesses the contact of a frame, for a solve to start from. The finger is
/// that of the present parameters. A measured contact location is taken as it
/// is. Otherwise the contact is searched for, by the place of the object or by
/// the gauges: a fit to their blocks (FrameFit) starts from a table of contacts
/// (gauge_table.h).
class ContactGuess {
 public:
  /// `problem` must stay in place. With `many` frames to guess, they are fitted
  /// on a surface (frame_surface.h). Throws InputError for a finger without an
  /// unloaded equilibrium.
  explicit ContactGuess(CalibrationProblem* problem, bool many = false);
  /// For another thread. Both share the surface.
  ContactGuess(const ContactGuess& other);
  ContactGuess& operator=(const ContactGuess&) = delete;

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

  const GaugeTable& table() const { return *table_; }
  /// Says whether this guess was made for many frames.
  bool many() const { return surface_ != nullptr; }

 private:
  // Takes from a frame what the contact is searched by.
  void Take(const CalibrationFrame& frame, bool object, bool gauges);
  void PackCircle();
  void PackGauges();
  Place FromTable(bool fit);
  FrameLinearizer Linearizer() const;

  CalibrationProblem& problem_;
  EquilibriumSolver solver_;
  std::shared_ptr<const GaugeTable> table_;
  std::shared_ptr<const ModelSurface> surface_;  // null: none
  FrameLinearizer linearizer_;
  CalibrationFrame taken_;
  LinearizedFrame at_;
  Eigen::VectorXd values_, weights_;  // gauges, then the circle's centre
};

}  // namespace finray

#endif  // FINRAY_CALIB_SOLVE_CONTACT_GUESS_H_
