#include "finray/statics/circle_contact.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "finray/statics/shape.h"

namespace finray {
namespace {

constexpr int kMaxIterations = 30;
constexpr double kTolerance = 1e-12;  // of l_0
constexpr double kSmallestRampStep = 1e-3;

// Newton in (l_c, f_c) on the tangency equations, each evaluation an
// equilibrium. Steps in l_c are limited: beyond a bay the tangent is worthless.
bool SolveTangency(const Circle& circle, EquilibriumSolver* solver,
                   PointContact* contact) {
  const double length = solver->model().finger().front_length_mm;
  const double longest_move = length / 10;
  const int row = solver->model().gauges();
  std::vector<PointContact> contacts(1);
  for (int i = 0; i < kMaxIterations; ++i) {
    contacts[0] = *contact;
    if (!solver->SolveWithSensitivities(contacts)) return false;
    const Eigen::Vector3d pose = solver->contact_pose(0);
    const Eigen::Vector2d tangent(std::cos(pose.z()), std::sin(pose.z()));
    const Eigen::Vector2d normal(tangent.y(), -tangent.x());
    const Eigen::Vector2d gap =
        pose.head<2>() - circle.radius_mm * normal - circle.center_mm;
    if (gap.norm() <= kTolerance * length) return true;
    const auto d_pose = solver->d_outputs().block<3, 2>(row, 0);
    const Eigen::Matrix2d d_gap =
        d_pose.topRows<2>() - circle.radius_mm * tangent * d_pose.row(2);
    const Eigen::Vector2d step = -d_gap.partialPivLu().solve(gap);
    if (!step.allFinite()) return false;
    const double fraction =
        std::min(1.0, longest_move / std::max(std::abs(step[0]), 1e-300));
    contact->arc_mm =
        std::clamp(contact->arc_mm + fraction * step[0], 0.0, length);
    contact->normal_N += fraction * step[1];
  }
  return false;
}

}  // namespace

CircleTouch FindTouch(const Circle& circle, const EquilibriumSolver& free) {
  const Shape shape(free, {});
  const double length = free.model().finger().front_length_mm;
  // The free beam bends little, so its distance to the centre has one minimum
  // between samples this dense; (centre - r) . t has the root there.
  constexpr int kSamples = 200;
  const auto offset = [&](double arc) {
    const Section at = shape.At(Side::kFront, arc);
    return Eigen::Vector2d(circle.center_mm -
                           Eigen::Vector2d(at.x_mm, at.y_mm));
  };
  int nearest = 0;
  double least = offset(0).norm();
  for (int i = 1; i <= kSamples; ++i) {
    const double distance = offset(length * i / kSamples).norm();
    if (distance < least) {
      least = distance;
      nearest = i;
    }
  }
  double low = length * std::max(nearest - 1, 0) / kSamples;
  double high = length * std::min(nearest + 1, kSamples) / kSamples;
  const auto ahead = [&](double arc) {
    const double theta = shape.At(Side::kFront, arc).theta_rad;
    return offset(arc).dot(Eigen::Vector2d(std::cos(theta), std::sin(theta)));
  };
  const bool tangent = ahead(low) >= 0 && ahead(high) <= 0;
  for (int i = 0; tangent && i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (ahead(middle) >= 0 ? low : high) = middle;
  }
  CircleTouch touch;
  touch.arc_mm = tangent ? 0.5 * (low + high) : length * nearest / kSamples;
  const double theta = shape.At(Side::kFront, touch.arc_mm).theta_rad;
  touch.normal = {std::sin(theta), -std::cos(theta)};
  touch.depth_mm = circle.radius_mm + offset(touch.arc_mm).dot(touch.normal);
  touch.distance_mm = offset(touch.arc_mm).norm();
  touch.tangent = tangent;
  return touch;
}

CircleContactStatus SolveCircleContact(const Circle& circle, double friction,
                                       EquilibriumSolver* solver,
                                       PointContact* contact) {
  contact->friction = friction;
  if (contact->normal_N > 0) {
    PointContact guess = *contact;
    if (SolveTangency(circle, solver, &guess) && guess.normal_N > 0) {
      *contact = guess;
      return CircleContactStatus::kContact;
    }
  }

  contact->normal_N = 0;
  if (!solver->Solve({})) return CircleContactStatus::kNotConverged;
  const CircleTouch touch = FindTouch(circle, *solver);
  if (!touch.tangent) {
    return touch.distance_mm >= circle.radius_mm
               ? CircleContactStatus::kNoContact
               : CircleContactStatus::kNoTangency;
  }
  if (touch.depth_mm <= 0) return CircleContactStatus::kNoContact;

  PointContact reached{touch.arc_mm, 0, friction};
  LadderState reached_state = solver->state();
  double fraction = 0, step = 1;
  while (fraction < 1) {
    const double next = std::min(1.0, fraction + step);
    Circle moved = circle;
    moved.center_mm -= (1 - next) * touch.depth_mm * touch.normal;
    PointContact guess = reached;
    if (SolveTangency(moved, solver, &guess) && guess.normal_N > 0) {
      fraction = next;
      reached = guess;
      reached_state = solver->state();
      step *= 1.5;
    } else {
      solver->set_state(reached_state);
      step *= 0.5;
      if (step < kSmallestRampStep) return CircleContactStatus::kNotConverged;
    }
  }
  *contact = reached;
  return CircleContactStatus::kContact;
}

}  // namespace finray
