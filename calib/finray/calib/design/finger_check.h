#ifndef FINRAY_CALIB_DESIGN_FINGER_CHECK_H_
#define FINRAY_CALIB_DESIGN_FINGER_CHECK_H_

#include <array>
#include <string>
#include <vector>

#include "finray/calib/design/written_beams.h"
#include "finray/finger/discretization.h"
#include "finray/finger/finger.h"
#include "finray/io/warning.h"

namespace finray {

/// A rib as the finger has it.
struct RibFigures {
  double front_mm, back_mm;
  double angle_deg;  ///< At the front beam, from +x.
  double length_mm, nominal_mm;
  double tension_N;  ///< In the finger at rest: that of assembly prestress.
};

/// How the finger answers to a small force at one height of the front beam.
struct HeightFigures {
  double contact_mm;
  /// Force per displacement of the contact along x, N per mm.
  double stiffness_N_per_mm;
  std::vector<double> angle_rad_per_N;  ///< Of each gauge.
};

/// The largest force that a finger carries at one height.
struct LimitLoad {
  double contact_mm;
  /// The path of equilibria from rest turns back here. Else the largest force
  /// that was reached.
  double force_N;
  bool folds;
};

/// The figures of a finger that a drawing does not show.
struct FingerCheck {
  double back_length_mm, back_base_mm;  ///< back_base_mm is along x.
  std::vector<RibFigures> ribs;
  /// At a quarter, half and three quarters of the front beam.
  std::array<HeightFigures, 3> heights;
  LimitLoad limit;
  double force_unit_N;  ///< EI / l_0^2, ForceUnit().
  std::vector<Warning> warnings;
};

/// Computes the figures and looks for what is implausible: modulus, thickness,
/// angles, ribs that nearly cross, gauges that overlap or feel nothing, gains
/// that nobody has calibrated. Nothing of that makes a finger invalid; what
/// does is refused by ReadFinger. Throws InputError for a finger that no scheme
/// can model, std::runtime_error for one without an equilibrium at rest.
FingerCheck CheckFinger(const Finger& finger,
                        const std::vector<WrittenPlate>& plates,
                        const Discretization& discretization);

/// The forces that the search for a limit load ends at, in units of EI /
/// l_0^2.
constexpr double kLargestCheckedLoad = 200;

/// Returns the warnings of the plates and of the bending stiffness alone: units
/// that were mixed up.
std::vector<Warning> StiffnessWarnings(const Finger& finger,
                                       const std::vector<WrittenPlate>& plates);

/// Returns the warnings; `figures` has everything else.
std::vector<Warning> FingerWarnings(const Finger& finger,
                                    const std::vector<WrittenPlate>& plates,
                                    const FingerCheck& figures);

}  // namespace finray

#endif  // FINRAY_CALIB_DESIGN_FINGER_CHECK_H_
