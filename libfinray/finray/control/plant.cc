#include "finray/control/plant.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "finray/finger/discretization.h"
#include "finray/finger/finger_parameter.h"
#include "finray/finger/point_contact.h"
#include "finray/scene/clean_readings.h"

namespace finray {
namespace {

using Eigen::Vector2d;

// Finer than an estimator's default.
constexpr Discretization kPlantDiscretization{Scheme::kTaylor, 64};
constexpr double kBalanced_N = 1e-6;
constexpr int kMostShifts = 60;
constexpr double kLongestShift_mm = 2;

const char* Reason(ObjectContactStatus status) {
  return status == ObjectContactStatus::kNoTangency
             ? "the object meets an end of the front beam, not its side"
             : "no equilibrium found against the object";
}

}  // namespace

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
      default:  // effects are not among them
        break;
    }
    SetParameter(parameter, value + std * unit(*generator), &perturbed);
  }
  return perturbed;
}

Plant::Plant(const std::vector<Finger>& fingers, const Mechanism& mechanism,
             const RigidObject& object, double friction,
             const ObjectStart& start)
    : mechanism_(mechanism), object_(object), friction_(friction) {
  if (mechanism.is_gripper() && object.spring) {
    throw std::invalid_argument(
        "an object between two fingers stands on no spring");
  }
  for (const Finger& finger : fingers) {
    fingers_.push_back({EquilibriumSolver(finger, kPlantDiscretization), {}});
  }
  const Pose<double> turn = MakePose<double>(start.angle_rad, Vector2d::Zero());
  const double reach =
      turn.Rotate(object.outline.PointAt(-start.angle_rad).position_mm).x();
  start_ = {Vector2d(-start.gap_mm - reach, start.y_mm), start.angle_rad};
}

bool Plant::Solve(std::size_t i, double drive, double x_mm, PlantState* state) {
  const auto base = mechanism_.FingerPose(drive);
  if (!base) {
    state->failure = "the linkage cannot be closed";
    return false;
  }
  TrueFinger& finger = fingers_[i];
  PlantFinger& result = state->fingers[i];
  const double turn = std::atan2(base->s, base->c);
  // In the mirrored world the object is turned by (pi - angle) and its outline
  // is mirrored, which is the same for outlines that are symmetric about y.
  const double angle = i == 1 ? -start_.angle_rad : start_.angle_rad;
  result.object = {base->Inverse() * Vector2d(x_mm, start_.position_mm.y()),
                   angle - turn};
  const ObjectContact found = SolveObjectContact(
      object_, result.object, friction_, &finger.solver, finger.contacts);
  finger.contacts = found.contacts;
  if (found.status != ObjectContactStatus::kContact &&
      found.status != ObjectContactStatus::kNoContact) {
    state->failure = Reason(found.status);
    return false;
  }
  result.contacts = found.contacts;
  result.displacement_mm = found.displacement_mm;
  result.readings = CleanReadings(finger.solver);
  Vector2d force = Vector2d::Zero();
  for (std::size_t c = 0; c < found.contacts.size(); ++c) {
    force += ContactForce(found.contacts[c],
                          finger.solver.contact_pose(static_cast<int>(c)).z());
  }
  result.force_N = base->Rotate(force);
  return true;
}

// Finds the root of the difference of forces, which grows with the shift, by
// secant steps. They stay within the bracket once there is one.
bool Plant::Balance(double drive, double motion_mm, PlantState* state) {
  const double middle = start_.position_mm.x(), here = middle + motion_mm;
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  double last_shift = 0, last_difference = 0;
  for (int step = 0; step < kMostShifts; ++step) {
    if (!Solve(0, drive, here + shift_mm_, state) ||
        !Solve(1, drive, 2 * middle - here - shift_mm_, state)) {
      return false;
    }
    const double difference =
        state->fingers[0].force_N.x() - state->fingers[1].force_N.x();
    if (std::abs(difference) < kBalanced_N) return true;
    (difference > 0 ? high : low) = shift_mm_;
    if (step > 0) {
      const double secant =
          (difference - last_difference) / (shift_mm_ - last_shift);
      if (secant > 0) slope_N_per_mm_ = secant;
    }
    last_shift = shift_mm_;
    last_difference = difference;
    shift_mm_ -= std::clamp(difference / slope_N_per_mm_, -kLongestShift_mm,
                            kLongestShift_mm);
    if (shift_mm_ <= low || shift_mm_ >= high) shift_mm_ = 0.5 * (low + high);
  }
  state->failure = "the forces of both fingers do not balance";
  return false;
}

PlantState Plant::At(double drive, double motion_mm) {
  PlantState state;
  state.fingers.resize(fingers_.size());
  const bool solved =
      fingers_.size() == 2
          ? Balance(drive, motion_mm, &state)
          : Solve(0, drive, start_.position_mm.x() + motion_mm, &state);
  if (!solved) return state;
  for (const PlantFinger& finger : state.fingers) {
    state.force_N +=
        finger.force_N.norm() / static_cast<double>(fingers_.size());
  }
  return state;
}

}  // namespace finray
