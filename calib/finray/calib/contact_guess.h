#ifndef FINRAY_CALIB_CONTACT_GUESS_H_
#define FINRAY_CALIB_CONTACT_GUESS_H_

#include <Eigen/Core>
#include <optional>

#include "finray/sensing/contact_fit.h"
#include "finray/sensing/gauge_table.h"
#include "finray/sensing/scene.h"

namespace finray {

/// Where a frame's contact is according to the finger as it is given, for a
/// calibration to start from: the nearest place of a table (gauge_table.h),
/// which knows it to a few bays.
class ContactGuess {
 public:
  /// Throws InputError for a finger without an unloaded equilibrium.
  ContactGuess(const Finger& finger, const Scene& scene,
               const Discretization& discretization);

  struct Place {
    double arc_mm = 0, normal_N = 0;
    LadderState state;  ///< An equilibrium near it.
  };

  /// The contact at which the scene's circle touches, its centre being there.
  /// It is met exactly: what all stiffnesses and forces have in common may not
  /// be in the data, and stays as given only from a start near a solution.
  std::optional<Place> FromCircle(const Eigen::Vector2d& centre_mm);

  /// From gauge angles, weighted per rad (0: not measured).
  std::optional<Place> FromGauges(const Eigen::VectorXd& angles_rad,
                                  const Eigen::VectorXd& weights);

 private:
  bool FindStart();

  EquilibriumSolver solver_;
  GaugeTable table_;
  ContactFit fit_;
  Eigen::VectorXd values_, weights_;  // gauges, then the circle's centre
  std::vector<ContactStart> starts_;
};

}  // namespace finray

#endif  // FINRAY_CALIB_CONTACT_GUESS_H_
