#include "finray/sensing/contact_smoother.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace finray {
namespace {

constexpr int kMostSmootherIterations = 30;
constexpr double kMostSmootherDamping = 1e6;
// A step that lowers the cost by less than this is the last.
constexpr double kLeastCostDecrease = 1e-6;
// Down to this share of its force at a time.
constexpr double kLeastForceShare = 0.3;

Eigen::Matrix2d ChangeInformation(const Scene& scene) {
  const Smoothing& q = *scene.smoothing;
  return Eigen::Vector2d(1 / (q.contact_mm * q.contact_mm),
                         1 / (q.normal_N * q.normal_N))
      .asDiagonal();
}

bool IsOneContact(const FrameEstimate& estimate) {
  return estimate.contacts == 1 && estimate.contact[0].normal_N > 0;
}

}  // namespace

ContactSmoother::ContactSmoother(const Finger& finger, const Scene& scene,
                                 const Discretization& discretization)
    : finger_(finger),
      scene_(scene),
      solver_(finger, discretization),
      contacts_(1),
      change_information_(ChangeInformation(scene)) {}

void ContactSmoother::Smooth(const Measurements* readings, std::size_t count,
                             const std::optional<Belief>& before,
                             FrameEstimate* estimates) {
  last_.reset();
  smoothed_.assign(count, false);
  for (std::size_t begin = 0; begin < count;) {
    if (!IsOneContact(estimates[begin])) {
      last_.reset();
      ++begin;
      continue;
    }
    std::size_t end = begin + 1;
    while (end < count && IsOneContact(estimates[end])) ++end;
    const bool smoothed =
        SmoothRun(readings + begin, end - begin,
                  begin == 0 ? before : std::nullopt, estimates + begin);
    std::fill(smoothed_.begin() + static_cast<long>(begin),
              smoothed_.begin() + static_cast<long>(end), smoothed);
    begin = end;
  }
}

bool ContactSmoother::SmoothRun(const Measurements* readings, std::size_t count,
                                const std::optional<Belief>& before,
                                FrameEstimate* estimates) {
  last_.reset();
  if (frames_.size() < count) frames_.resize(count);
  for (std::size_t t = 0; t < count; ++t) {
    Pack(finger_, scene_, readings[t], &frames_[t].measurement);
    frames_[t].measurement.weights /= estimates[t].noise_scale();
    frames_[t].x = {estimates[t].contact[0].arc_mm,
                    estimates[t].contact[0].normal_N};
  }
  solver_.Reset();
  if (!Linearize(count)) return false;  // the frames remain what they are
  if (count == 1 && !before) {
    // Nothing to be smoothed with, but the next frame may be.
    const Eigen::Matrix2d covariance = frames_[0].information.inverse();
    if (covariance.allFinite()) last_ = {frames_[0].x, covariance};
    return false;
  }
  double damping = 0;
  std::vector<Eigen::Vector2d> x(count);
  for (int i = 0; i < kMostSmootherIterations; ++i) {
    const double cost = Cost(count, before);
    Eliminate(count, damping, before);
    double expected = 0;
    for (std::size_t t = 0; t < count; ++t) {
      const Frame& frame = frames_[t];
      expected += frame.step.dot(frame.information * frame.step);
    }
    // At the minimum to rounding, or, as a NaN, nowhere.
    if (!(expected > kLeastCostDecrease)) break;
    for (std::size_t t = 0; t < count; ++t) {
      Frame& frame = frames_[t];
      x[t] = frame.x;
      frame.x += frame.step;
      frame.x[0] = std::clamp(frame.x[0], 0.0, finger_.front_length_mm);
      frame.x[1] = std::max(frame.x[1], kLeastForceShare * x[t][1]);
    }
    const bool lower = Linearize(count) && Cost(count, before) < cost;
    if (lower) {
      if (cost - Cost(count, before) < kLeastCostDecrease) break;
      damping *= 0.1;
      continue;
    }
    for (std::size_t t = 0; t < count; ++t) frames_[t].x = x[t];
    if (!Linearize(count)) return false;
    damping = std::max(1e-3, 10 * damping);
    if (damping > kMostSmootherDamping) break;
  }
  Eliminate(count, 0, before);
  for (std::size_t t = 0; t < count; ++t) {
    const Frame& frame = frames_[t];
    const Eigen::Matrix2d covariance = Covariance(t);
    if (!covariance.allFinite()) {
      last_.reset();
      return false;
    }
    ContactEstimate& contact = estimates[t].contact[0];
    contact.arc_mm = frame.x[0];
    contact.normal_N = frame.x[1];
    contact.arc_std_mm = std::sqrt(covariance(0, 0));
    contact.normal_std_N = std::sqrt(covariance(1, 1));
    contact.pose = frame.pose;
    estimates[t].tip_pose = frame.tip_pose;
    estimates[t].rib_tension_N = frame.rib_tension_N;
    last_ = {frame.x, covariance};
  }
  return true;
}

bool ContactSmoother::Linearize(std::size_t count) {
  for (std::size_t t = 0; t < count; ++t) {
    Frame& frame = frames_[t];
    contacts_[0] = {frame.x[0], frame.x[1], scene_.friction_coefficient};
    if (!at_.At(contacts_, frame.measurement, MeasuredRadius(scene_),
                &solver_)) {
      return false;
    }
    frame.chi2 = at_.chi2();
    frame.information = at_.information();
    frame.gradient = at_.slope.transpose() * at_.residual;
    frame.pose = solver_.contact_pose(0);
    frame.tip_pose = solver_.tip_pose();
    frame.rib_tension_N.resize(finger_.ribs.size());
    for (std::size_t i = 0; i < finger_.ribs.size(); ++i) {
      frame.rib_tension_N[i] = solver_.rib_tension(static_cast<int>(i));
    }
  }
  return true;
}

double ContactSmoother::Cost(std::size_t count,
                             const std::optional<Belief>& before) const {
  double cost = 0;
  for (std::size_t t = 0; t < count; ++t) {
    cost += frames_[t].chi2;
    if (t == 0) continue;
    const Eigen::Vector2d change = frames_[t].x - frames_[t - 1].x;
    cost += change.dot(change_information_ * change);
  }
  if (before) {
    const Eigen::Vector2d change = frames_[0].x - before->mean;
    cost += change.dot(
        (before->covariance + change_information_.inverse()).inverse() *
        change);
  }
  return cost;
}

// Block Thomas. `forward` holds what frames up to t know of x_t, `backward`
// what those from t on do.
void ContactSmoother::Eliminate(std::size_t count, double damping,
                                const std::optional<Belief>& before) {
  const Eigen::Matrix2d& q = change_information_;
  for (std::size_t t = 0; t < count; ++t) {
    Frame& frame = frames_[t];
    frame.forward = frame.information;
    frame.forward.diagonal() *= 1 + damping;
    frame.right = -frame.gradient;
    if (t == 0 && before) {
      const Eigen::Matrix2d known =
          (before->covariance + q.inverse()).inverse();
      frame.forward += known;
      frame.right -= known * (frame.x - before->mean);
    }
    if (t > 0) {
      const Frame& last = frames_[t - 1];
      // What is known of x_{t-1}, blurred by the change.
      const Eigen::Matrix2d passed = q * (last.forward + q).inverse();
      frame.forward += q - passed * q;
      // Both ends of the change: eliminated x_{t-1} with its own pull.
      const Eigen::Vector2d pull = q * (frame.x - last.x);
      frame.right += -pull + passed * (last.right + pull);
    }
  }
  for (std::size_t t = count; t-- > 0;) {
    Frame& frame = frames_[t];
    frame.backward = frame.information;
    if (t + 1 == count) {
      frame.step = frame.forward.inverse() * frame.right;
      continue;
    }
    const Frame& next = frames_[t + 1];
    frame.backward += q - q * (next.backward + q).inverse() * q;
    const Eigen::Vector2d pull = q * (next.x - frame.x + next.step);
    frame.step = (frame.forward + q).inverse() * (frame.right + pull);
  }
}

Eigen::Matrix2d ContactSmoother::Covariance(std::size_t t) const {
  const Frame& frame = frames_[t];
  return (frame.forward + frame.backward - frame.information).inverse();
}

}  // namespace finray
