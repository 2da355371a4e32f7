#include "finray/statics/load_path.h"

#include <algorithm>
#include <cmath>

#include "finray/ladder/rib_law.h"

namespace finray {
namespace {

// Arc lengths of the path are in rad and l_0, root mean square over the nodes.
constexpr double kLargestStep = 0.15;
constexpr double kSmallestStep = 1e-7;
constexpr int kMaxCorrections = 8;
constexpr double kTolerance = 1e-9;
constexpr int kMostSteps = 2000;
// A longer correction has left the step that it belongs to.
constexpr double kLargestCorrection = 6 * kLargestStep;
// The least cosine between the tangents of neighbouring points.
constexpr double kLeastCosine = 0.5;
// The largest gap between a step and the mean of the tangents at its ends, over
// the step, and the gap that Newton's tolerance explains.
constexpr double kLargestGap = 0.05;
constexpr double kNoGap = 1e-5;
// A step to the goal aims this far past it, as lambda' mostly falls.
constexpr double kBeyond = 1.2;
// A limit point is found if lambda' is below this share of its change within
// the step.
constexpr double kTurned = 1e-3;

}  // namespace

LoadPath::LoadPath(LadderNewton* newton,
                   const std::vector<PointContact>& contacts, double fraction)
    : newton_(newton), contacts_(contacts), fraction_(fraction) {
  Keep(&start_);
}

Eigen::Index LoadPath::Size() const { return newton_->frame().state_size(); }

void LoadPath::Keep(Eigen::VectorXd* state) const {
  *state = Eigen::Map<const Eigen::VectorXd>(newton_->frame().state.q, Size());
}

void LoadPath::Restore(const Eigen::VectorXd& state) {
  Eigen::Map<Eigen::VectorXd>(newton_->frame().state.q, Size()) = state;
}

// The mean product over x, y and theta of the nodes.
double LoadPath::Dot(const double* a, const double* b) const {
  const LadderFrame<double>& f = newton_->frame();
  const int first = 6 + f.ribs, count = 3 * f.elements;
  double sum = 0;
  for (int i = first; i < first + count; ++i) sum += a[i] * b[i];
  return sum / f.elements;
}

// Finds the unit tangent at the present point, at `fraction` of the load, in
// the direction of travel. `slope` is its component along the load.
bool LoadPath::FindTangent(double fraction, Eigen::VectorXd* tangent,
                           double* slope) {
  if (!newton_->Linearize(contacts_, fraction)) return false;
  const double* by_load = newton_->frame().by_load.q;
  const double norm = std::sqrt(Dot(by_load, by_load) + 1);
  if (!std::isfinite(norm)) return false;
  double sign = 1;
  if (tangent_.size() == Size()) {
    sign = Dot(tangent_.data(), by_load) + tangent_fraction_ < 0 ? -1 : 1;
  } else if (tangent_.size() > 0) {
    // The mesh has changed. It does so only where lambda' keeps its sign.
    sign = tangent_fraction_ < 0 ? -1 : 1;
  }
  *tangent = sign / norm * Eigen::Map<const Eigen::VectorXd>(by_load, Size());
  *slope = sign / norm;
  return true;
}

bool LoadPath::Tangent() {
  Eigen::VectorXd tangent;
  if (!FindTangent(fraction_, &tangent, &tangent_fraction_)) return false;
  tangent_.swap(tangent);
  return true;
}

// Solves equilibrium and the arc length equation together by Newton's method.
bool LoadPath::GoTo(double arc) {
  Restore(start_ + arc * tangent_);
  trial_fraction_ = fraction_ + arc * tangent_fraction_;
  const LadderFrame<double>& f = newton_->frame();
  Eigen::VectorXd moved(Size());
  for (corrections_ = 0; corrections_ < kMaxCorrections; ++corrections_) {
    if (!newton_->Linearize(contacts_, trial_fraction_)) return false;
    moved = Eigen::Map<const Eigen::VectorXd>(f.state.q, Size()) - start_ +
            Eigen::Map<const Eigen::VectorXd>(f.step.q, Size());
    const double slope = Dot(tangent_.data(), f.by_load.q) + tangent_fraction_;
    const double change = (arc - Dot(tangent_.data(), moved.data()) -
                           tangent_fraction_ * (trial_fraction_ - fraction_)) /
                          slope;
    const double size = newton_->Size(1, change);
    if (!std::isfinite(size) || size > kLargestCorrection) return false;
    newton_->Move(1, change);
    trial_fraction_ += change;
    if (size < kTolerance || (corrections_ > 0 && size < 1e-6)) return true;
  }
  return false;
}

// The largest share of the load within a step of length `arc` that ends with
// lambda' = `end_slope`. Regula falsi finds the zero of lambda', which falls
// about linearly.
double LoadPath::LimitFraction(double arc, double end_slope) {
  double limit = std::max(fraction_, trial_fraction_);
  double from = 0, from_slope = tangent_fraction_;
  double to = arc, to_slope = end_slope;
  const double turned = kTurned * (from_slope - to_slope);
  Eigen::VectorXd tangent;
  for (int i = 0; i < kMaxCorrections; ++i) {
    const double at = from + (to - from) * from_slope / (from_slope - to_slope);
    double slope = 0;
    if (!GoTo(at) || !FindTangent(trial_fraction_, &tangent, &slope)) break;
    limit = std::max(limit, trial_fraction_);
    if (std::abs(slope) < turned) break;
    (slope > 0 ? from : to) = at;
    (slope > 0 ? from_slope : to_slope) = slope;
  }
  return limit;
}

// Whether the point reached lies on the same smooth path: the step must agree
// with the mean of the tangents at its ends. Near a bifurcation another path
// runs on with nearly the same tangent where the finger's own path bends off
// sharply; only this gap tells them apart. The load is left out, as it would
// hide the shape.
bool LoadPath::Joins(const Eigen::VectorXd& reached,
                     const Eigen::VectorXd& tangent, double slope) const {
  if (Dot(tangent.data(), tangent_.data()) + slope * tangent_fraction_ <
      kLeastCosine) {
    return false;
  }
  const Eigen::VectorXd chord = reached - start_;
  const Eigen::VectorXd gap = chord - 0.5 * step_ * (tangent_ + tangent);
  return std::sqrt(Dot(gap.data(), gap.data())) <
         kLargestGap * std::sqrt(Dot(chord.data(), chord.data())) + kNoGap;
}

// Refines the mesh if needed. If it returns false the path is lost, as the step
// began on another mesh and cannot be repeated.
bool LoadPath::Refine() {
  const MeshChange change = newton_->RefineMesh();
  if (change != MeshChange::kRefined) return change == MeshChange::kNone;
  return newton_->Converge(contacts_, fraction_, SweepColumns::kLoad) &&
         Tangent();
}

bool LoadPath::Advance(double goal) {
  passed_limit_point_ = false;
  if (lost_ || (tangent_.size() == 0 && !Tangent())) return false;
  if (tangent_fraction_ > 0 && goal > fraction_) {
    step_ = std::min(step_, kBeyond * (goal - fraction_) / tangent_fraction_ +
                                10 * kSmallestStep);
  }
  Eigen::VectorXd reached, tangent;
  for (; step_ > kSmallestStep; step_ *= 0.4) {
    if (!GoTo(step_)) continue;
    const double fraction = trial_fraction_;
    const bool quick = corrections_ <= 3;
    double slope = 0;
    Keep(&reached);
    if (!FindTangent(fraction, &tangent, &slope) ||
        !Joins(reached, tangent, slope)) {
      continue;
    }
    const bool turns = (slope < 0) != (tangent_fraction_ < 0);
    if (turns && slope < 0) {
      const double limit = LimitFraction(step_, slope);
      // The goal lies before the limit point: a shorter step ends there.
      if (limit > goal) continue;
      passed_limit_point_ = true;
      limit_fraction_ = limit;
      Restore(reached);
    }
    fraction_ = fraction;
    tangent_.swap(tangent);
    tangent_fraction_ = slope;
    if (!turns && !Refine()) {
      lost_ = true;
      return false;
    }
    Keep(&start_);
    if (quick) step_ = std::min(kLargestStep, 1.5 * step_);
    return true;
  }
  Restore(start_);
  return false;
}

SolveStatus WalkLoadPath(const std::vector<PointContact>& contacts,
                         LadderNewton* newton, double* fraction) {
  newton->Reset();
  *fraction = 0;
  if (!newton->Converge(contacts, 0, SweepColumns::kLoad)) {
    return SolveStatus::kNotConverged;
  }
  LoadPath path(newton, contacts, 0);
  for (int i = 0; i < kMostSteps; ++i) {
    const bool advanced = path.Advance(1);
    *fraction = path.fraction();
    if (BendsTooFar(newton->frame())) return SolveStatus::kRibTooBent;
    if (!advanced) break;
    if (path.passed_limit_point()) {
      *fraction = path.limit_fraction();
      return SolveStatus::kLimitPoint;
    }
    if (path.fraction() >= 1) {
      // Back along the tangent to the load itself.
      newton->Move(0, (1 - path.fraction()));
      *fraction = 1;
      return SolveStatus::kSolved;
    }
  }
  return SolveStatus::kNotConverged;
}

}  // namespace finray
