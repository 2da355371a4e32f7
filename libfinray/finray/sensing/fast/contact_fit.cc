#include "finray/sensing/fast/contact_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "finray/objects/circle_centre.h"

namespace finray {
namespace {

constexpr int kMaxIterations = 60;
// Gauss-Newton converges slowly where the data hardly determine the contacts.
// After kPatience iterations the fit ends when a change is below kNoDifference:
// in std for the contacts, in rad and l_0 for the shape.
constexpr int kPatience = 8;
constexpr double kNoDifference = 1e-5;

}  // namespace

ContactFit::ContactFit(const Finger& finger,
                       const Discretization& discretization,
                       std::optional<double> circle_radius_mm)
    : newton_(finger, discretization), circle_radius_mm_(circle_radius_mm) {
  const int rows = newton_.model().gauges() + (circle_radius_mm ? 2 : 0);
  reading_.resize(rows);
  residual_.resize(rows);
  d_reading_.resize(rows, 2 * kFittedContacts);
  d_reading_before_.resize(rows, 2 * kFittedContacts);
  slope_.resize(rows, 2 * kFittedContacts);
}

// Reads the gauges' angles and slopes. The readout maps hold the values before
// the step; the taps add the change that the step makes.
void ContactFit::ReadGauges(int unknowns) {
  const LadderFrame<double>& f = newton_.frame();
  d_reading_before_.swap(d_reading_);
  reading_.setZero();
  d_reading_.setZero();
  for (int i = 0; i < f.readout_count; ++i) {
    const LadderReadout<double>& readout = f.readouts[i];
    const double* tap = f.taps + f.readout_tap(i) * f.stride + f.affine;
    reading_[readout.gauge] +=
        readout.sign * (f.readout_map[kReadoutValues * i] + tap[0]);
    for (int k = 0; k < unknowns; ++k) {
      d_reading_(readout.gauge, k) += readout.sign * tap[1 + k];
    }
  }
  if (circle_radius_mm_) ReadCentre(*circle_radius_mm_, unknowns);
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
    reading_[gauges + i] = at[i] + change(0);
    for (int k = 0; k < unknowns; ++k) {
      d_reading_(gauges + i, k) = change(1 + k);
    }
  }
}

void ContactFit::Whiten(const Eigen::VectorXd& measured,
                        const Eigen::VectorXd& weights, int unknowns) {
  residual_.array() = (reading_ - measured).array() * weights.array();
  slope_ = d_reading_;
  slope_.array().colwise() *= weights.array();
  equations_.normal.resize(unknowns, unknowns);
  equations_.gradient.resize(unknowns);
  for (int k = 0; k < unknowns; ++k) {
    equations_.gradient[k] = slope_.col(k).dot(residual_);
    for (int l = 0; l <= k; ++l) {
      equations_.normal(k, l) = equations_.normal(l, k) =
          slope_.col(k).dot(slope_.col(l));
    }
  }
  equations_.chi2 = residual_.squaredNorm();
}

// CurvatureRate for the step between the last two linearisations.
double ContactFit::Rate(const Eigen::VectorXd& weights, double damping,
                        const ContactVector& step,
                        const ContactVector& x) const {
  const int unknowns = static_cast<int>(x.size());
  ContactVector by_residual = ContactVector::Zero(unknowns);
  for (int k = 0; k < unknowns; ++k) {
    for (Eigen::Index j = 0; j < residual_.size(); ++j) {
      by_residual[k] += weights[j] * residual_[j] *
                        (d_reading_(j, k) - d_reading_before_(j, k));
    }
  }
  return CurvatureRate(equations_, damping, by_residual, step, x);
}

// Reads the poses of contacts and tip at the end of the step, as in ReadGauges.
void ContactFit::ReadPoses(int contacts, const ContactVector& change) {
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
  return Run(measured, weights, false, contacts);
}

bool ContactFit::Follow(const Eigen::VectorXd& measured,
                        const Eigen::VectorXd& weights,
                        std::vector<PointContact>* contacts) {
  return Run(measured, weights,
             linearised_contacts_ == static_cast<int>(contacts->size()),
             contacts);
}

bool ContactFit::Run(const Eigen::VectorXd& measured,
                     const Eigen::VectorXd& weights, bool predict,
                     std::vector<PointContact>* contacts) {
  const int count = static_cast<int>(contacts->size());
  const int unknowns = 2 * count;
  const double length = newton_.workspace().length_unit();
  const double force = newton_.workspace().force_unit();
  const BeamMesh& mesh = newton_.model().mesh(Side::kFront);
  linearised_contacts_ = 0;
  if (count < 1 || count > kFittedContacts) return false;
  double last_cost = std::numeric_limits<double>::infinity();
  double damping = 0, last_change = kUnknownChange;
  ContactVector x(unknowns), step;
  // True if step_ leads from one linearisation to the next.
  bool comparable = predict;
  for (iterations_ = predict ? 0 : 1; iterations_ <= kMaxIterations;
       ++iterations_) {
    // The prediction uses the last linearisation of the frame before, whose
    // Newton step has already been taken.
    const bool predicts = iterations_ == 0;
    if (!predicts) {
      if (!newton_.LinearizeByContacts(*contacts)) return false;
      ReadGauges(unknowns);
      step = step_;
      step_.setZero(unknowns);
    }
    Whiten(measured, weights, unknowns);
    if (!std::isfinite(equations_.chi2)) return false;
    if (equations_.chi2 > kMostRise * last_cost + 1 && damping < 1e6) {
      Restore(contacts);
      damping = std::max(1e-3, 100 * damping);
      last_cost = std::numeric_limits<double>::infinity();
      last_change = kUnknownChange;
      comparable = false;
      continue;
    }
    Keep(*contacts);
    last_cost = equations_.chi2;
    for (int c = 0; c < count; ++c) {
      x[2 * c] = (*contacts)[c].arc_mm / length;
      x[2 * c + 1] = (*contacts)[c].normal_N / force;
    }
    const ContactVector change =
        BoundedChange(equations_, x, most_force_N_ / force, damping);
    newton_.StepWithContacts(predicts ? 0 : 1, change.data());
    const double size = newton_.Size(1, 0);
    if (!std::isfinite(size)) return false;
    const double share = std::min(1.0, kMaxTurn_rad / size);
    newton_.Move(share, 0);
    const double moved = LargestChange(change, x, size);
    bool crossed = false;
    for (int c = 0; c < count; ++c) {
      PointContact& contact = (*contacts)[c];
      const int before = mesh.Locate(contact.arc_mm).element;
      contact.arc_mm = std::clamp(
          contact.arc_mm + share * change[2 * c] * length, 0.0, length);
      contact.normal_N =
          std::max(0.0, contact.normal_N + share * change[2 * c + 1] * force);
      crossed |= mesh.Locate(contact.arc_mm).element != before;
    }
    step_ += share * change;
    reading_.noalias() += d_reading_.leftCols(unknowns) * change;
    residual_.noalias() += slope_.leftCols(unknowns) * change;
    const double rate =
        comparable && !predicts ? Rate(weights, damping, step, x) : 0;
    const double deviations = std::sqrt(change.dot(equations_.normal * change));
    const bool last =
        IsLastChange(moved, last_change, rate, crossed, tolerance_) ||
        (iterations_ >= kPatience && deviations < kNoDifference &&
         size < kNoDifference);
    damping *= 0.1;
    last_change = moved;
    comparable = true;
    if (predicts || !last) continue;
    ReadPoses(count, change);
    chi2_ = residual_.squaredNorm();
    information_ = equations_.normal;
    for (int k = 0; k < unknowns; ++k) {
      const double unit = k % 2 == 0 ? length : force;
      information_.row(k) /= unit;
      information_.col(k) /= unit;
    }
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
  }
  return false;
}

}  // namespace finray
