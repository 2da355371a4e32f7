#ifndef FINRAY_CALIB_DESIGN_CONTACT_ACCURACY_H_
#define FINRAY_CALIB_DESIGN_CONTACT_ACCURACY_H_

#include <Eigen/Core>
#include <vector>

#include "finray/fit/calibration_errors.h"
#include "finray/statics/equilibrium.h"

namespace finray {

/// The predicted std of the contacts that one frame of gauges tells: (l_c in
/// mm, f_c in N) of each contact. Infinite where the gauges do not determine
/// them.
struct ContactStd {
  Eigen::VectorXd noise;  ///< By the noise of the gauges alone.
  Eigen::VectorXd total;  ///< With the errors of the calibration.
};

/// Predicts the std of estimates, the square root of
///
///   diag[(J'WJ)^-1 + C_sys],
///
/// with the derivatives J of the gauges' angles by the contacts, and C_sys of
/// the finger's calibration (CalibrationErrors). It is the linear part: it
/// holds where the std is small against the distance over which J changes.
class ContactAccuracy {
 public:
  /// Gauges with hysteresis were anywhere in their loops before the touch.
  ContactAccuracy(const Finger& finger, double friction,
                  const Discretization& discretization);

  /// One or two contacts on the front beam, with their forces.
  ContactStd At(const std::vector<PointContact>& contacts);

 private:
  EquilibriumSolver solver_;
  CalibrationErrors systematic_;
  std::vector<double> free_rad_;  // gauge angles without a contact
};

/// The largest std over a region of the front beam, at one force.
struct WorstStd {
  double place_mm = 0, place_at_mm = 0;
  double force_N = 0, force_at_mm = 0;
};

/// Heights of a region, its ends included, at most 2.5 mm apart.
std::vector<double> HeightsOf(double from_mm, double to_mm);

/// The worst std of one contact at these heights, calibration included.
WorstStd WorstOf(const std::vector<double>& heights_mm, double normal_N,
                 double friction, ContactAccuracy* accuracy);

}  // namespace finray

#endif  // FINRAY_CALIB_DESIGN_CONTACT_ACCURACY_H_
