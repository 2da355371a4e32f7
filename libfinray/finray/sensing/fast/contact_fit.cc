#include "finray/sensing/fast/contact_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "finray/ladder/contact_pose.h"
#include "finray/ladder/rib_law.h"
#include "finray/objects/circle_centre.h"
#include "finray/sensing/fast/step_pace.h"

namespace finray {
namespace {

// Gauss-Newton converges slowly where the data hardly determine the contacts.
// After kPatience iterations the fit ends when a change is below kNoDifference:
// in std for the contacts, in rad and l_0 for the shape.
constexpr int kPatience = 8;
constexpr double kNoDifference = 1e-6;
// Where the tolerance is worth more std than this, as with a noise of a few
// rounding errors, the last change must be below it, not only the next one.
constexpr double kTolerableStd = 0.1;

}  // namespace

ContactFit::ContactFit(const Finger& finger,
                       const Discretization& discretization,
                       std::optional<double> circle_radius_mm)
    : newton_(finger, discretization),
      circle_radius_mm_(circle_radius_mm),
      gauges_(newton_.model().gauges() + (circle_radius_mm ? 2 : 0)) {}

void ContactFit::ReadCentre(double radius_mm, int unknowns) {
  const LadderFrame<double>& f = newton_.frame();
  const double length = newton_.workspace().length_unit();
  const int gauges = newton_.model().gauges();
  Eigen::Vector3d contact = ContactPose(f, 0);
  contact.head<2>() *= length;
  const double theta = contact.z();
  const Eigen::Vector2d at = CircleCentre(contact, radius_mm);
  const Eigen::Vector2d by_angle = CircleCentreByAngle(theta, radius_mm);
  const double* pose = f.taps + f.contact_tap(0) * f.stride + f.affine;
  for (int i = 0; i < 2; ++i) {
    const auto change = [&](int column) {
      return length * pose[i * f.stride + column] +
             by_angle[i] * pose[2 * f.stride + column];
    };
    gauges_.angle[gauges + i] = at[i] + change(0);
    for (int k = 0; k < unknowns; ++k) {
      gauges_.slope[k][gauges + i] = change(1 + k);
    }
  }
}

void ContactFit::Keep(const std::vector<PointContact>& contacts) {
  const LadderFrame<double>& f = newton_.frame();
  kept_state_.assign(f.state.q, f.state.q + f.state_size());
  kept_contacts_ = contacts;
}

void ContactFit::Restore(std::vector<PointContact>* contacts) {
  std::copy(kept_state_.begin(), kept_state_.end(), newton_.frame().state.q);
  *contacts = kept_contacts_;
}

bool ContactFit::Fit(const Readings& measured, const Readings& weights,
                     std::vector<PointContact>* contacts) {
  linearised_contacts_ = 0;
  return Follow(measured, weights, contacts);
}

bool ContactFit::Follow(const Readings& measured, const Readings& weights,
                        std::vector<PointContact>* contacts) {
  const int count = static_cast<int>(contacts->size());
  const bool predict = linearised_contacts_ == count;
  const int unknowns = 2 * count;
  const double length = newton_.workspace().length_unit();
  const double force = newton_.workspace().force_unit();
  const BeamMesh& mesh = newton_.model().mesh(Side::kFront);
  linearised_contacts_ = 0;
  if (count < 1 || count > kFittedContacts) return false;
  double last_cost = std::numeric_limits<double>::infinity();
  double damping = 0, last_change = kUnknownChange;
  ContactVector x(unknowns), step;
  StepPace pace;
  // True if step_ leads from one linearisation to the next.
  bool comparable = predict;
  for (iterations_ = predict ? 0 : 1; iterations_ <= most_iterations_;
       ++iterations_) {
    // The prediction uses the last linearisation of the frame before, whose
    // Newton step has already been taken.
    const bool predicts = iterations_ == 0;
    if (!predicts) {
      if (!newton_.Linearize(*contacts, 1, SweepColumns::kContacts)) {
        return false;
      }
      gauges_.Read(newton_.frame(), unknowns);
      if (circle_radius_mm_) ReadCentre(*circle_radius_mm_, unknowns);
      step = step_;
      step_.setZero(unknowns);
    }
    const ContactEquations equations =
        gauges_.Equations(measured, weights, unknowns);
    if (!std::isfinite(equations.chi2)) return false;
    if (equations.chi2 > kMostRise * last_cost + 1 && damping < 1e6) {
      Restore(contacts);
      damping = std::max(1e-3, 100 * damping);
      last_cost = std::numeric_limits<double>::infinity();
      last_change = kUnknownChange;
      comparable = false;
      pace.Reset();
      continue;
    }
    Keep(*contacts);
    last_cost = equations.chi2;
    for (int c = 0; c < count; ++c) {
      x[2 * c] = (*contacts)[c].arc_mm / length;
      x[2 * c + 1] = (*contacts)[c].normal_N / force;
    }
    ContactVector change =
        BoundedChange(equations, x, most_force_N_ / force, damping);
    const double taken = pace.Of(change, x);
    change *= taken;
    for (int k = 0; k < unknowns; ++k) {
      const double most = k % 2 == 0 ? 1 : most_force_N_ / force;
      change[k] = std::clamp(change[k], -x[k], most - x[k]);
    }
    newton_.StepWithContacts(predicts ? 0 : 1, change.data());
    const double size = newton_.Size(1, 0);
    if (!std::isfinite(size)) return false;
    const double share = std::min(1.0, kMaxTurn_rad / size);
    newton_.Move(share, 0);
    const double moved = LargestChange(change, x, size);
    ContactVector moves = share * change;
    bool crossed = false;
    for (int c = 0; c < count; ++c) {
      PointContact& contact = (*contacts)[c];
      moves[2 * c] *= ArcShare(x[2 * c + 1], moves[2 * c + 1]);
      crossed |= MoveContact(mesh, &moves[2 * c], length, force,
                             &contact.arc_mm, &contact.normal_N);
    }
    step_ += moves;
    gauges_.Move(change);
    const double rate =
        comparable && !predicts
            ? gauges_.Rate(measured, weights, equations, damping, step, x)
            : 0;
    const double deviations = std::sqrt(change.dot(equations.normal * change));
    const bool small =
        moved < tolerance_ || tolerance_ * deviations < kTolerableStd * moved;
    const bool last = (small && IsLastChange(moved, last_change, rate, crossed,
                                             tolerance_)) ||
                      (iterations_ >= kPatience &&
                       deviations < std::min(1.0, taken) * kNoDifference &&
                       size < kNoDifference);
    damping *= 0.1;
    last_change = moved;
    comparable = true;
    if (predicts || !last) continue;
    const LadderFrame<double>& f = newton_.frame();
    if (BendsTooFar(f)) return false;
    for (int c = 0; c < count; ++c) {
      poses_[f.contacts[c].index] = PoseAfter(f, c, length, change);
    }
    poses_[kFittedContacts] = PoseAfter(f, count, length, change);
    chi2_ = gauges_.Chi2(measured, weights);
    information_ = InformationOf(equations.normal, length, force);
    switch (newton_.RefineMesh()) {
      case MeshChange::kNone:
        linearised_contacts_ = count;
        return true;
      case MeshChange::kRefined:
        break;
      case MeshChange::kTooFine:
        return false;
    }
    last_cost = std::numeric_limits<double>::infinity();
    last_change = kUnknownChange;
    comparable = false;
    pace.Reset();
  }
  iterations_ = most_iterations_;
  return false;
}

}  // namespace finray
