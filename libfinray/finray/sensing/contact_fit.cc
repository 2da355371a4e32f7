#include "finray/sensing/contact_fit.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

#include "finray/sensing/circle_centre.h"

namespace finray {
namespace {

constexpr int kMaxIterations = 60;
// Where the data hardly tell, Gauss-Newton converges slowly. After this many
// iterations a change that makes no difference to chi2 is enough, in standard
// deviations and, for the shape, rad and l_0.
constexpr int kPatience = 8;
constexpr double kNoDifference = 1e-4;
// Beyond these a linearisation says nothing: a bay, a quarter turn.
constexpr double kLongestMove = 0.1;  // of l_0
constexpr double kMaxTurn_rad = 0.7;
// Levenberg's damping of l_c as of a prior of 30 mm about where it is, which
// keeps a contact of no force from wandering; it vanishes with chi2, so that
// convergence to data without noise stays quadratic.
constexpr double kArcDamping = 22;
// A change that raises chi2 by this factor and by more than 1 is taken back.
// Less says little: before equilibrium is reached chi2 is known to first order
// only.
constexpr double kMostRise = 2;
constexpr double kLeastForce = 0.02;  // in units of EI / l_0^2

}  // namespace

ContactFit::ContactFit(const Finger& finger,
                       const Discretization& discretization,
                       std::optional<double> circle_radius_mm)
    : newton_(finger, discretization), circle_radius_mm_(circle_radius_mm) {
  const int rows = newton_.model().gauges() + (circle_radius_mm ? 2 : 0);
  residual_.resize(rows);
  slope_.resize(rows, 2 * kFittedContacts);
}

// Values of the state before the step, brought to its end by the taps.
void ContactFit::ReadMeasurements(const Eigen::VectorXd& measured,
                                  const Eigen::VectorXd& weights,
                                  int unknowns) {
  const LadderFrame<double>& f = newton_.frame();
  residual_ = -measured;
  slope_.setZero();
  for (int i = 0; i < f.readout_count; ++i) {
    const LadderReadout<double>& readout = f.readouts[i];
    const double* tap = f.taps + f.readout_tap(i) * f.stride + f.affine;
    residual_[readout.gauge] +=
        readout.sign * (f.readout_map[kReadoutValues * i] + tap[0]);
    for (int k = 0; k < unknowns; ++k) {
      slope_(readout.gauge, k) += readout.sign * tap[1 + k];
    }
  }
  if (circle_radius_mm_) ReadCentre(*circle_radius_mm_, unknowns);
  residual_.array() *= weights.array();
  slope_.array().colwise() *= weights.array();
  normal_.resize(unknowns, unknowns);
  gradient_.resize(unknowns);
  for (int k = 0; k < unknowns; ++k) {
    gradient_[k] = slope_.col(k).dot(residual_);
    for (int l = 0; l <= k; ++l) {
      normal_(k, l) = normal_(l, k) = slope_.col(k).dot(slope_.col(l));
    }
  }
}

void ContactFit::ReadCentre(double radius_mm, int unknowns) {
  const LadderFrame<double>& f = newton_.frame();
  const double length = newton_.workspace().length_unit();
  const int slot = f.elements, gauges = newton_.model().gauges();
  const double theta = f.slot_theta[slot];
  const Eigen::Vector2d at = CircleCentre(
      {length * f.slot_x[slot], length * f.slot_y[slot], theta}, radius_mm);
  const Eigen::Vector2d by_angle = CircleCentreByAngle(theta, radius_mm);
  const double* pose = f.taps + f.contact_tap(0) * f.stride + f.affine;
  for (int i = 0; i < 2; ++i) {
    const auto change = [&](int column) {
      return length * pose[i * f.stride + column] +
             by_angle[i] * pose[2 * f.stride + column];
    };
    residual_[gauges + i] += at[i] + change(0);
    for (int k = 0; k < unknowns; ++k) {
      slope_(gauges + i, k) = change(1 + k);
    }
  }
}

// Poses of contacts and tip, brought to the end of the step likewise.
void ContactFit::ReadPoses(int contacts, const Change& change) {
  const LadderFrame<double>& f = newton_.frame();
  const double length = newton_.workspace().length_unit();
  const auto pose = [&](int tap, double x, double y, double theta) {
    Eigen::Vector3d at(x, y, theta);
    for (int i = 0; i < 3; ++i) {
      const double* row = f.taps + (tap + i) * f.stride + f.affine;
      at[i] += row[0];
      for (int k = 0; k < change.size(); ++k) at[i] += row[1 + k] * change[k];
    }
    at.head<2>() *= length;
    return at;
  };
  for (int c = 0; c < contacts; ++c) {
    const int index = f.contacts[c].index, slot = f.elements + c;
    poses_[index] = pose(f.contact_tap(index), f.slot_x[slot], f.slot_y[slot],
                         f.slot_theta[slot]);
  }
  poses_[kFittedContacts] = pose(f.tip_tap(), f.tip[0], f.tip[1], f.tip[2]);
}

// The damped Gauss-Newton change; what would pass a bound stays at it and the
// rest is solved for anew.
ContactFit::Change ContactFit::BoundedChange(
    const std::vector<PointContact>& contacts, double damping) const {
  const int unknowns = static_cast<int>(gradient_.size());
  const double length = newton_.workspace().length_unit();
  const double force = newton_.workspace().force_unit();
  const double unexplained = std::min(1.0, residual_.squaredNorm());
  Information system = normal_;
  for (int k = 0; k < unknowns; ++k) {
    system(k, k) *= 1 + damping;
    system(k, k) += k % 2 == 0 ? kArcDamping * unexplained : 1e-9;
  }
  Change rest = -gradient_, change = Change::Zero(unknowns);
  bool fixed[2 * kFittedContacts] = {};
  for (int pass = 0; pass <= unknowns; ++pass) {
    Information free = system;
    Change right = rest;
    for (int k = 0; k < unknowns; ++k) {
      if (!fixed[k]) continue;
      right -= system.col(k) * change[k];
    }
    for (int k = 0; k < unknowns; ++k) {
      if (!fixed[k]) continue;
      free.row(k).setZero();
      free.col(k).setZero();
      free(k, k) = 1;
      right[k] = change[k];
    }
    change = free.ldlt().solve(right);
    bool inside = true;
    for (int k = 0; k < unknowns; ++k) {
      const PointContact& contact = contacts[k / 2];
      const bool arc = k % 2 == 0;
      const double at =
          arc ? contact.arc_mm / length : contact.normal_N / force;
      const double low = std::max(-at, arc ? -kLongestMove : -at);
      const double high =
          arc ? std::min(1 - at, kLongestMove) : most_force_N_ / force - at;
      const double bounded = std::clamp(change[k], low, high);
      if (fixed[k] || bounded == change[k]) continue;
      change[k] = bounded;
      fixed[k] = true;
      inside = false;
    }
    if (inside) break;
  }
  return change;
}

void ContactFit::Keep(const std::vector<PointContact>& contacts) {
  const LadderFrame<double>& f = newton_.frame();
  kept_state_.assign(f.state.q, f.state.q + 6 + f.ribs + 4 * f.elements);
  kept_contacts_ = contacts;
}

void ContactFit::Restore(std::vector<PointContact>* contacts) {
  std::copy(kept_state_.begin(), kept_state_.end(), newton_.frame().state.q);
  *contacts = kept_contacts_;
}

bool ContactFit::Fit(const Eigen::VectorXd& measured,
                     const Eigen::VectorXd& weights,
                     std::vector<PointContact>* contacts) {
  const int count = static_cast<int>(contacts->size());
  const int unknowns = 2 * count;
  const double length = newton_.workspace().length_unit();
  const double force = newton_.workspace().force_unit();
  if (count < 1 || count > kFittedContacts) return false;
  double last_cost = std::numeric_limits<double>::infinity();
  double damping = 0, last_change = 1;
  for (iterations_ = 1; iterations_ <= kMaxIterations; ++iterations_) {
    if (!newton_.LinearizeByContacts(*contacts)) return false;
    ReadMeasurements(measured, weights, unknowns);
    const double cost = residual_.squaredNorm();
    if (!std::isfinite(cost)) return false;
    if (cost > kMostRise * last_cost + 1 && damping < 1e6) {
      Restore(contacts);
      damping = std::max(1e-3, 100 * damping);
      last_cost = std::numeric_limits<double>::infinity();
      continue;
    }
    Keep(*contacts);
    last_cost = cost;
    const Change change = BoundedChange(*contacts, damping);
    newton_.StepWithContacts(change.data());
    const double size = newton_.Size(1, 0);
    if (!std::isfinite(size)) return false;
    const double share = std::min(1.0, kMaxTurn_rad / size);
    newton_.Move(share, 0);
    double moved = size;
    for (int c = 0; c < count; ++c) {
      PointContact& contact = (*contacts)[c];
      contact.arc_mm = std::clamp(
          contact.arc_mm + share * change[2 * c] * length, 0.0, length);
      const double before = contact.normal_N / force;
      contact.normal_N =
          std::max(0.0, contact.normal_N + share * change[2 * c + 1] * force);
      moved = std::max({moved, std::abs(change[2 * c]),
                        std::abs(change[2 * c + 1]) / (before + kLeastForce)});
    }
    damping *= 0.1;
    const double ratio = moved / last_change;
    const double deviations = std::sqrt(change.dot(normal_ * change));
    if (moved * std::min(1.0, ratio) < tolerance_ ||
        (iterations_ >= kPatience && deviations < kNoDifference &&
         size < kNoDifference)) {
      ReadPoses(count, change);
      residual_.noalias() += slope_.leftCols(unknowns) * change;
      chi2_ = residual_.squaredNorm();
      information_ = normal_;
      for (int k = 0; k < unknowns; ++k) {
        const double unit = k % 2 == 0 ? length : force;
        information_.row(k) /= unit;
        information_.col(k) /= unit;
      }
      if (!newton_.RefineMesh()) return true;
      last_cost = std::numeric_limits<double>::infinity();
    }
    last_change = moved;
  }
  return false;
}

}  // namespace finray
