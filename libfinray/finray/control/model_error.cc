#include "finray/control/model_error.h"

#include "finray/finger/finger_parameter.h"

namespace finray {

Finger Perturbed(const Finger& finger, const ModelError& error,
                 std::mt19937_64* generator) {
  Finger perturbed = finger;
  std::normal_distribution<double> unit;
  for (const FingerParameter& parameter : ParametersOf(finger)) {
    const double value = ParameterValue(finger, parameter);
    double std = 0;
    switch (parameter.kind) {
      case FingerParameterKind::kFrontStiffness:
      case FingerParameterKind::kBackStiffness:
        std = 0.01 * error.stiffness_percent * value;
        break;
      case FingerParameterKind::kGaugeGain:
        std = 0.01 * error.gauge_gain_percent * value;
        break;
      case FingerParameterKind::kGaugeOffset:
        std = error.gauge_offset_V;
        break;
      case FingerParameterKind::kRibLength:
        std = error.rib_length_mm;
        break;
    }
    SetParameter(parameter, value + std * unit(*generator), &perturbed);
  }
  return perturbed;
}

}  // namespace finray
