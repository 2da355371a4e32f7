#ifndef FINRAY_FINGER_FINGER_PARAMETER_H_
#define FINRAY_FINGER_FINGER_PARAMETER_H_

#include <string>
#include <vector>

namespace finray {

struct Finger;

/// The kinds of numbers of a finger that a calibration may determine.
enum class FingerParameterKind {
  kFrontStiffness,
  kBackStiffness,
  kGaugeGain,
  kGaugeOffset,
  kRibLength,
};
constexpr int kFingerParameterKinds = 5;

/// One number of a finger that a calibration may determine.
struct FingerParameter {
  FingerParameterKind kind;
  int index = 0;  ///< The gauge or rib, from 0; 0 for a beam's stiffness.

  bool operator==(const FingerParameter& other) const {
    return kind == other.kind && index == other.index;
  }
};

/// All parameters of a finger: front and back stiffness, gains, offsets, rib
/// lengths. Every list of parameters has this order.
std::vector<FingerParameter> ParametersOf(const Finger& finger);

/// The name in files, where indices count from 1: "gauge_1_gain_V_per_rad".
std::string ParameterName(const FingerParameter& parameter);
const char* ParameterUnit(FingerParameterKind kind);

double ParameterValue(const Finger& finger, const FingerParameter& parameter);
void SetParameter(const FingerParameter& parameter, double value,
                  Finger* finger);

}  // namespace finray

#endif  // FINRAY_FINGER_FINGER_PARAMETER_H_
