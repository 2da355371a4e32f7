#ifndef FINRAY_MODEL_SHARED_PARAMETERS_H_
#define FINRAY_MODEL_SHARED_PARAMETERS_H_

#include <vector>

#include "finray/finger/finger_parameter.h"

namespace finray {

/// The parameters of a finger that all frames share. Stiffness enters as its
/// logarithm, because it is positive and its errors are relative.
struct SharedParameters {
  double ln_front_stiffness = 0;  ///< ln(EI / N mm^2)
  double ln_back_stiffness = 0;
  std::vector<double> rib_lengths_mm;
  /// Places of the gauges. Only frames with movable gauges use them.
  std::vector<double> gauge_starts_mm, gauge_lengths_mm;

  /// Effects inside the equilibrium that are varied, and whether friction is.
  std::vector<FingerParameter> effects;
  bool friction_varies = false;
  /// Their values, one parameter block; friction is the last one.
  std::vector<double> effect_values;

  static SharedParameters Of(const Finger& finger,
                             std::vector<FingerParameter> effects = {});
};

}  // namespace finray

#endif  // FINRAY_MODEL_SHARED_PARAMETERS_H_
