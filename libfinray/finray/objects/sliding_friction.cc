#include "finray/objects/sliding_friction.h"

#include <algorithm>
#include <cmath>

#include "finray/objects/approaches.h"

namespace finray {
namespace {

using Eigen::Vector2d;

constexpr int kMostTrials = 60;
constexpr double kStateTolerance = 1e-7;

Vector2d Along(double theta_rad) {
  return {std::cos(theta_rad), std::sin(theta_rad)};
}

}  // namespace

SlidingFriction::SlidingFriction(const RigidObject& object, double coefficient,
                                 double presliding_mm, double object_std_mm)
    : object_(object),
      coefficient_(std::max(0.0, coefficient)),
      presliding_mm_(presliding_mm),
      moves_mm_(kMoves * M_SQRT2 * object_std_mm) {}

std::optional<double> SlidingFriction::Next(const ObjectPose& measured,
                                            EquilibriumSolver* solver) {
  if (!measured.position_mm.allFinite()) {
    touches_ = false;
    return {};
  }
  if (touches_ &&
      std::abs(
          Along(last_.theta_rad).dot(measured.position_mm - last_.object_mm)) >
          kLifted_mm) {
    touches_ = false;
  }
  const ObjectPose pose = touches_ ? Held(measured) : measured;
  double state = 0;
  Place place{};
  if ((!touches_ && !Begin(pose, solver)) ||
      !FindState(pose, solver, &state, &place)) {
    touches_ = false;
    return {};
  }
  touches_ = true;
  held_ = pose;
  last_ = place;
  state_ = state;
  return state_ * coefficient_;
}

// A coordinate that has not moved beyond noise stays where it was.
ObjectPose SlidingFriction::Held(const ObjectPose& measured) {
  ObjectPose pose = measured;
  for (int i = 0; i < 2; ++i) {
    const double was = held_.position_mm[i];
    if (std::abs(pose.position_mm[i] - was) <= moves_mm_) {
      pose.position_mm[i] = was;
    }
  }
  return pose;
}

// Puts the object back along the normal at its deepest point, where it would
// just touch the free finger.
bool SlidingFriction::Begin(const ObjectPose& pose, EquilibriumSolver* solver) {
  contact_ = {ObjectContactStatus::kNotConverged, {}, 0};
  solver->Reset();
  if (!solver->Solve({})) return false;
  const Shape free = Shape::OfFront(*solver, {});
  const double length = solver->model().finger().front_length_mm;
  const std::vector<Approach> approaches =
      FindApproaches(free, length, {}, object_.outline, pose, 0);
  const auto deepest = std::min_element(approaches.begin(), approaches.end(),
                                        [](const auto& a, const auto& b) {
                                          return a.distance_mm < b.distance_mm;
                                        });
  if (deepest == approaches.end() || deepest->at_end) return false;
  const Section at = free.SurfaceAt(Side::kFront, deepest->arc_mm);
  const Vector2d along = Along(at.theta_rad), outward(-along.y(), along.x());
  last_ = {deepest->arc_mm,
           at.theta_rad,
           {at.x_mm, at.y_mm},
           pose.position_mm - std::min(0.0, deepest->distance_mm) * outward,
           pose.angle_rad};
  state_ = 0;
  return true;
}

// Finds the contact at a state; false if it is not one point.
bool SlidingFriction::Solve(const ObjectPose& pose, double state,
                            EquilibriumSolver* solver, Place* place) {
  contact_ = SolveObjectContact(object_, pose, state * coefficient_, solver,
                                contact_.contacts);
  if (contact_.contacts.size() != 1) return false;
  const Eigen::Vector3d at = solver->contact_pose(0);
  Vector2d centre = pose.position_mm;
  if (object_.spring) {
    centre += contact_.displacement_mm * Along(object_.spring->direction_rad);
  }
  *place = {contact_.contacts[0].arc_mm, at.z(), at.head<2>(), centre,
            pose.angle_rad};
  return true;
}

double SlidingFriction::Slip(const Place& place) const {
  const Vector2d along = Along(0.5 * (place.theta_rad + last_.theta_rad));
  const Vector2d arm = 0.5 * (place.point_mm - place.object_mm +
                              last_.point_mm - last_.object_mm);
  const double turn = place.object_rad - last_.object_rad;
  return place.arc_mm - last_.arc_mm +
         along.dot(place.object_mm - last_.object_mm -
                   (place.point_mm - last_.point_mm) +
                   turn * Vector2d(-arm.y(), arm.x()));
}

double SlidingFriction::StateAfter(double slip) const {
  const double way = slip < 0 ? -1 : 1;
  return way + (state_ - way) * std::exp(-std::abs(slip) / presliding_mm_);
}

// The zero of StateAfter(Slip(at z)) - z, which falls with z because friction
// drags the beam along. It lies between the state before and the end that slip
// leads to.
bool SlidingFriction::FindState(const ObjectPose& pose,
                                EquilibriumSolver* solver, double* state,
                                Place* place) {
  const auto excess = [&](double z, double* value) {
    if (!Solve(pose, z, solver, place)) return false;
    *value = StateAfter(Slip(*place)) - z;
    return true;
  };
  double low = state_, at_low = 0;
  *state = low;
  if (!excess(low, &at_low)) return false;
  if (std::abs(at_low) < kStateTolerance) return true;
  if (coefficient_ == 0) {
    *state = low + at_low;
    return true;
  }
  double high = at_low > 0 ? 1 : -1, at_high = 0;
  *state = high;
  if (!excess(high, &at_high)) return false;
  if (std::abs(at_high) < kStateTolerance) return true;
  // Regula falsi; an end that stays twice counts half (Illinois), and every
  // fourth trial is the middle, as the law is steep in a narrow place.
  int stayed = 0;
  for (int trial = 1; trial <= kMostTrials; ++trial) {
    double z = low + (high - low) * at_low / (at_low - at_high);
    if (trial % 4 == 0 || !std::isfinite(z)) z = 0.5 * (low + high);
    double at = 0;
    *state = z;
    if (!excess(z, &at)) return false;
    if (std::abs(at) < kStateTolerance ||
        std::abs(high - low) < kStateTolerance) {
      return true;
    }
    const bool beside_low = (at > 0) == (at_low > 0);
    if (beside_low) {
      low = z;
      at_low = at;
      if (stayed > 0) at_high /= 2;
      stayed = 1;
    } else {
      high = z;
      at_high = at;
      if (stayed < 0) at_low /= 2;
      stayed = -1;
    }
  }
  return true;
}

}  // namespace finray
