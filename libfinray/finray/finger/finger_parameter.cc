#include "finray/finger/finger_parameter.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "finray/finger/finger.h"
#include "finray/finger/geometry.h"

namespace finray {
namespace {

template <class Ribs>
auto& FirstBending(Ribs& ribs) {
  return *std::find_if(ribs.begin(), ribs.end(),
                       [](const Rib& rib) { return rib.Bends(); });
}

// The member of a finger, const or not, that holds a parameter.
template <class AnyFinger>
auto& Variable(AnyFinger& finger, const FingerParameter& parameter) {
  switch (parameter.kind) {
    case FingerParameterKind::kFrontStiffness:
      return finger.front_stiffness_N_mm2;
    case FingerParameterKind::kBackStiffness:
      return finger.back_stiffness_N_mm2;
    case FingerParameterKind::kGaugeGain:
      return finger.gauges[parameter.index].gain_V_per_rad;
    case FingerParameterKind::kGaugeOffset:
      return finger.gauges[parameter.index].offset_V;
    case FingerParameterKind::kGaugeCurvature:
      return finger.gauges[parameter.index].curvature_per_rad;
    case FingerParameterKind::kGaugeStart:
      return finger.gauges[parameter.index].start_mm;
    case FingerParameterKind::kGaugeLength:
      return finger.gauges[parameter.index].length_mm;
    case FingerParameterKind::kGaugeCreepShare:
      return finger.gauges[parameter.index].creep_share;
    case FingerParameterKind::kGaugeCreepTime:
      return finger.gauges[parameter.index].creep_time_constant_s;
    case FingerParameterKind::kGaugeFlatShare:
      return finger.gauges[parameter.index].flat_share;
    case FingerParameterKind::kGaugeFlatWidth:
      return finger.gauges[parameter.index].flat_width_rad;
    case FingerParameterKind::kGaugeHysteresis:
      return finger.gauges[parameter.index].hysteresis_rad;
    case FingerParameterKind::kHingeStiffness:
      return finger.ribs[0].front_hinge_N_mm_per_rad;
    case FingerParameterKind::kRibBending:
      return FirstBending(finger.ribs).bending_stiffness_N_mm2;
    case FingerParameterKind::kFrontPiece:
      return finger.front_pieces[parameter.index].stiffness_ratio;
    case FingerParameterKind::kBackPiece:
      return finger.back_pieces[parameter.index].stiffness_ratio;
    case FingerParameterKind::kFrontHinge:
      return finger.ribs[parameter.index].front_mm;
    case FingerParameterKind::kBackHinge:
      return finger.ribs[parameter.index].back_mm;
    case FingerParameterKind::kFrontClamp:
      return finger.front_clamp_rad_per_N_mm;
    case FingerParameterKind::kBackClamp:
      return finger.back_clamp_rad_per_N_mm;
    case FingerParameterKind::kBackAngle:
      return finger.back_angle_rad;
    case FingerParameterKind::kSurfaceOffset:
      return finger.front_surface_mm;
    case FingerParameterKind::kRibLength:
    case FingerParameterKind::kFriction:
      break;
  }
  return finger.ribs[parameter.index].length_mm;
}

bool IsPiece(FingerParameterKind kind) {
  return kind == FingerParameterKind::kFrontPiece ||
         kind == FingerParameterKind::kBackPiece;
}

void Add(FingerParameterKind kind, std::size_t count,
         std::vector<FingerParameter>* all) {
  for (std::size_t i = 0; i < count; ++i) {
    all->push_back({kind, static_cast<int>(i)});
  }
}

}  // namespace

std::vector<FingerParameter> ParametersOf(const Finger& finger) {
  std::vector<FingerParameter> all = {{FingerParameterKind::kFrontStiffness},
                                      {FingerParameterKind::kBackStiffness}};
  Add(FingerParameterKind::kGaugeGain, finger.gauges.size(), &all);
  Add(FingerParameterKind::kGaugeOffset, finger.gauges.size(), &all);
  Add(FingerParameterKind::kRibLength, finger.ribs.size(), &all);
  return all;
}

std::vector<FingerParameter> AllParametersOf(const Finger& finger) {
  std::vector<FingerParameter> all = ParametersOf(finger);
  for (const FingerParameterKind kind :
       {FingerParameterKind::kGaugeCurvature, FingerParameterKind::kGaugeStart,
        FingerParameterKind::kGaugeLength,
        FingerParameterKind::kGaugeCreepShare,
        FingerParameterKind::kGaugeCreepTime,
        FingerParameterKind::kGaugeFlatShare,
        FingerParameterKind::kGaugeFlatWidth,
        FingerParameterKind::kGaugeHysteresis}) {
    Add(kind, finger.gauges.size(), &all);
  }
  if (!finger.ribs.empty()) {
    all.push_back({FingerParameterKind::kHingeStiffness});
  }
  if (FirstBendingRib(finger) != nullptr) {
    all.push_back({FingerParameterKind::kRibBending});
  }
  const auto add_pieces = [&](FingerParameterKind kind, std::size_t count) {
    for (std::size_t i = 1; i < count; ++i) {
      all.push_back({kind, static_cast<int>(i)});
    }
  };
  add_pieces(FingerParameterKind::kFrontPiece, finger.front_pieces.size());
  add_pieces(FingerParameterKind::kBackPiece, finger.back_pieces.size());
  Add(FingerParameterKind::kFrontHinge, finger.ribs.size(), &all);
  Add(FingerParameterKind::kBackHinge, finger.ribs.size(), &all);
  for (const FingerParameterKind kind :
       {FingerParameterKind::kFrontClamp, FingerParameterKind::kBackClamp,
        FingerParameterKind::kBackAngle, FingerParameterKind::kSurfaceOffset}) {
    all.push_back({kind});
  }
  return all;
}

std::string ParameterName(const FingerParameter& parameter) {
  // '#' stands for the number of the gauge or rib.
  constexpr const char* kNames[kFingerParameterKinds] = {
      "front_stiffness_N_mm2",
      "back_stiffness_N_mm2",
      "gauge_#_gain_V_per_rad",
      "gauge_#_offset_V",
      "rib_#_length_mm",
      "gauge_#_curvature_per_rad",
      "gauge_#_start_mm",
      "gauge_#_length_mm",
      "gauge_#_creep_share",
      "gauge_#_creep_time_constant_s",
      "gauge_#_flat_share",
      "gauge_#_flat_width_rad",
      "gauge_#_hysteresis_rad",
      "hinge_stiffness_N_mm_per_rad",
      "rib_bending_stiffness_N_mm2",
      "front_piece_#_stiffness_step",
      "back_piece_#_stiffness_step",
      "rib_#_front_mm",
      "rib_#_back_mm",
      "front_clamp_compliance_rad_per_N_mm",
      "back_clamp_compliance_rad_per_N_mm",
      "back_angle_deg",
      "front_surface_offset_mm",
      "friction_coefficient"};
  std::string name = kNames[static_cast<int>(parameter.kind)];
  const auto number = name.find('#');
  if (number != std::string::npos) {
    name.replace(number, 1, std::to_string(parameter.index + 1));
  }
  return name;
}

const char* ParameterUnit(FingerParameterKind kind) {
  constexpr const char* kUnits[kFingerParameterKinds] = {
      "N mm^2", "N mm^2",     "V/rad",      "V",   "mm", "1/rad",
      "mm",     "mm",         "1",          "s",   "1",  "rad",
      "rad",    "N mm/rad",   "N mm^2",     "1",   "1",  "mm",
      "mm",     "rad/(N mm)", "rad/(N mm)", "deg", "mm", "1"};
  return kUnits[static_cast<int>(kind)];
}

double ParameterValue(const Finger& finger, const FingerParameter& parameter) {
  const double value = Variable(finger, parameter);
  if (parameter.kind == FingerParameterKind::kBackAngle) return value / kDegree;
  if (!IsPiece(parameter.kind)) return value;
  return value / Variable(finger, {parameter.kind, parameter.index - 1});
}

void SetParameter(const FingerParameter& parameter, double value,
                  Finger* finger) {
  if (parameter.kind == FingerParameterKind::kHingeStiffness) {
    for (Rib& rib : finger->ribs) {
      rib.front_hinge_N_mm_per_rad = rib.back_hinge_N_mm_per_rad = value;
    }
    return;
  }
  if (parameter.kind == FingerParameterKind::kRibBending) {
    const double factor = value / ParameterValue(*finger, parameter);
    for (Rib& rib : finger->ribs) {
      if (rib.Bends()) rib.bending_stiffness_N_mm2 *= factor;
    }
    return;
  }
  if (parameter.kind == FingerParameterKind::kBackAngle) {
    finger->back_angle_rad = value * kDegree;
    if (!finger->back_pieces.empty()) {
      finger->back_pieces.back().end_mm = BeamLength(*finger, Side::kBack);
    }
    return;
  }
  if (IsPiece(parameter.kind)) {
    const double factor = value / ParameterValue(*finger, parameter);
    auto& pieces = parameter.kind == FingerParameterKind::kFrontPiece
                       ? finger->front_pieces
                       : finger->back_pieces;
    for (std::size_t i = static_cast<std::size_t>(parameter.index);
         i < pieces.size(); ++i) {
      pieces[i].stiffness_ratio *= factor;
    }
    return;
  }
  Variable(*finger, parameter) = value;
}

std::vector<FingerParameter> ParameterCovariance::StaticsEffects() const {
  std::vector<FingerParameter> effects;
  for (const FingerParameter& parameter : parameters) {
    if (IsStaticsEffect(parameter.kind) &&
        parameter.kind != FingerParameterKind::kFriction) {
      effects.push_back(parameter);
    }
  }
  return effects;
}

bool ParameterCovariance::HasFriction() const {
  return !parameters.empty() &&
         parameters.back().kind == FingerParameterKind::kFriction;
}

bool ParameterCovariance::HasGaugePlaces() const {
  return std::any_of(parameters.begin(), parameters.end(),
                     [](const FingerParameter& p) {
                       return p.kind == FingerParameterKind::kGaugeStart ||
                              p.kind == FingerParameterKind::kGaugeLength;
                     });
}

Eigen::MatrixXd ParameterCovariance::Factor() const {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(correlations);
  return std.asDiagonal() * eigen.eigenvectors() *
         eigen.eigenvalues().cwiseMax(0).cwiseSqrt().asDiagonal();
}

Finger WithoutCalibration(Finger finger) {
  finger.calibration.reset();
  return finger;
}

Finger WithFrictionReversed(Finger finger) {
  if (!finger.calibration || !finger.calibration->HasFriction()) return finger;
  ParameterCovariance& covariance = *finger.calibration;
  const Eigen::Index last = covariance.std.size() - 1;
  covariance.friction = -covariance.friction;
  covariance.correlations.row(last).head(last) *= -1;
  covariance.correlations.col(last).head(last) *= -1;
  return finger;
}

ParameterCovariance InOrderOf(const Finger& finger,
                              const ParameterCovariance& covariance) {
  ParameterCovariance ordered;
  std::vector<Eigen::Index> order;
  const auto& given = covariance.parameters;
  std::vector<FingerParameter> all = AllParametersOf(finger);
  all.push_back({FingerParameterKind::kFriction});
  for (const FingerParameter& parameter : all) {
    const auto at = std::find(given.begin(), given.end(), parameter);
    if (at == given.end()) continue;
    ordered.parameters.push_back(parameter);
    order.push_back(at - given.begin());
  }
  ordered.std = covariance.std(order);
  ordered.correlations = covariance.correlations(order, order);
  ordered.friction = covariance.friction;
  ordered.discrepancy = covariance.discrepancy;
  return ordered;
}

}  // namespace finray
