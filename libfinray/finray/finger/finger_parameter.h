#ifndef FINRAY_FINGER_FINGER_PARAMETER_H_
#define FINRAY_FINGER_FINGER_PARAMETER_H_

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "finray/finger/gauge_discrepancy.h"
#include "finray/io/nan.h"

namespace finray {

struct Finger;

/// The kinds of numbers of a finger that a calibration may determine.
enum class FingerParameterKind {
  kFrontStiffness,
  kBackStiffness,
  kGaugeGain,
  kGaugeOffset,
  kRibLength,
  kGaugeCurvature,
  kGaugeStart,
  kGaugeLength,
  kGaugeCreepShare,
  kGaugeCreepTime,
  kGaugeFlatShare,
  kGaugeFlatWidth,
  kGaugeHysteresis,
  kHingeStiffness,  ///< One for all hinges of the ribs.
  kRibBending,  ///< EI of the first rib that bends; others keep their ratio.
  // The stiffness of a piece, from the second one on, over that of the piece
  // before it. All pieces behind it change with it.
  kFrontPiece,
  kBackPiece,
  // The places of a rib's hinges. The rib keeps its length.
  kFrontHinge,
  kBackHinge,
  // The compliance of a clamp.
  kFrontClamp,
  kBackClamp,
  kBackAngle,      ///< In degrees.
  kSurfaceOffset,  ///< That of the front beam.
  // The friction coefficient against the object of a calibration. No finger has
  // one, but the covariance of its other parameters does.
  kFriction,
};
constexpr int kFingerParameterKinds = 24;

/// Says that a plain finger goes without this kind. Reports list its parameters
/// only where they are free.
constexpr bool IsEffect(FingerParameterKind kind) {
  return kind > FingerParameterKind::kRibLength;
}
/// Says that the kind is an effect inside the equilibrium. Derivatives by it
/// are carried on request only (LadderModel::set_effects).
constexpr bool IsStaticsEffect(FingerParameterKind kind) {
  return kind >= FingerParameterKind::kHingeStiffness;
}
constexpr bool IsHingePlace(FingerParameterKind kind) {
  return kind == FingerParameterKind::kFrontHinge ||
         kind == FingerParameterKind::kBackHinge;
}
/// Says that nodes of the mesh move with the kind.
constexpr bool MovesNodes(FingerParameterKind kind) {
  return IsHingePlace(kind) || kind == FingerParameterKind::kBackAngle;
}
/// Says that a value below 0 is no finger's, but a solve may pass through it.
constexpr bool IsAtLeastZero(FingerParameterKind kind) {
  return kind == FingerParameterKind::kFrontClamp ||
         kind == FingerParameterKind::kBackClamp ||
         kind == FingerParameterKind::kGaugeHysteresis;
}

/// One number of a finger that a calibration may determine.
struct FingerParameter {
  FingerParameterKind kind;
  int index = 0;  ///< The gauge, rib or piece, from 0; else 0.

  bool operator==(const FingerParameter& other) const {
    return kind == other.kind && index == other.index;
  }
};

/// The parameters of a plain finger: front and back stiffness, gains, offsets,
/// rib lengths.
std::vector<FingerParameter> ParametersOf(const Finger& finger);
/// These and the effects behind them. Every list of parameters has this order.
std::vector<FingerParameter> AllParametersOf(const Finger& finger);

/// The name in files, where indices count from 1: "gauge_1_gain_V_per_rad".
std::string ParameterName(const FingerParameter& parameter);
const char* ParameterUnit(FingerParameterKind kind);

double ParameterValue(const Finger& finger, const FingerParameter& parameter);
void SetParameter(const FingerParameter& parameter, double value,
                  Finger* finger);

/// The covariance of a finger's parameters after a calibration,
///
///   C_ij = std_i std_j correlation_ij,
///
/// in the units of their names. A parameter that is not listed counts as
/// exactly known.
struct ParameterCovariance {
  std::vector<FingerParameter> parameters;
  Eigen::VectorXd std;
  Eigen::MatrixXd correlations;  ///< Symmetric, 1 on the diagonal.
  /// The friction coefficient of the contacts that it is from; NaN if it is not
  /// known.
  double friction = kNaN;
  /// What the model misses whatever the parameters are, if it is known.
  std::optional<GaugeDiscrepancy> discrepancy;

  /// The statics effects of the finger among the parameters, in their order.
  std::vector<FingerParameter> StaticsEffects() const;
  /// Says whether the friction coefficient is among the parameters. It is the
  /// last one.
  bool HasFriction() const;
  /// Says whether the start or the length of a gauge is among the parameters.
  bool HasGaugePlaces() const;
  /// F with F F' = C. Negative eigenvalues count as 0.
  Eigen::MatrixXd Factor() const;
};

/// Returns the finger for contacts whose friction pulls the other way: the
/// friction in its covariance changes sign.
Finger WithFrictionReversed(Finger finger);
/// Returns the finger as if it were exactly known.
Finger WithoutCalibration(Finger finger);

/// Returns the covariance with its parameters in the order of ParametersOf.
ParameterCovariance InOrderOf(const Finger& finger,
                              const ParameterCovariance& covariance);

}  // namespace finray

#endif  // FINRAY_FINGER_FINGER_PARAMETER_H_
