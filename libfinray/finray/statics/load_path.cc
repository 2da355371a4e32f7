#include "finray/statics/load_path.h"

#include <algorithm>
#include <cmath>

namespace finray {
namespace {

// Arc lengths are in rad and l_0, root mean square over the nodes.
constexpr double kLargestStep = 0.15;
constexpr double kSmallestStep = 1e-7;
constexpr int kMaxCorrections = 8;
constexpr double kTolerance = 1e-9;
constexpr int kMostSteps = 2000;

}  // namespace

LoadPath::LoadPath(LadderNewton* newton,
                   const std::vector<PointContact>& contacts, double fraction)
    : newton_(newton), contacts_(contacts), fraction_(fraction) {
  Keep(&start_);
}

Eigen::Index LoadPath::Size() const {
  const LadderFrame<double>& f = newton_->frame();
  return 6 + f.ribs + 4 * f.elements;
}

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

// The unit tangent at the present point, pointing onwards.
bool LoadPath::Tangent() {
  if (!newton_->Linearize(contacts_, fraction_)) return false;
  const double* by_load = newton_->frame().by_load.q;
  const double norm = std::sqrt(Dot(by_load, by_load) + 1);
  if (!std::isfinite(norm)) return false;
  double sign = 1;
  if (has_tangent_ && tangent_.size() == Size()) {
    sign = Dot(tangent_.data(), by_load) + tangent_fraction_ < 0 ? -1 : 1;
  } else if (has_tangent_) {
    // On another mesh; between two steps lambda' keeps its sign but at a limit
    // point, and the mesh is not changed there.
    sign = tangent_fraction_ < 0 ? -1 : 1;
  }
  tangent_ = sign / norm * Eigen::Map<const Eigen::VectorXd>(by_load, Size());
  tangent_fraction_ = sign / norm;
  has_tangent_ = true;
  return true;
}

// Newton on equilibrium and the arc length equation together.
bool LoadPath::Correct(double arc) {
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
    if (!std::isfinite(size) || size > 2 * kLargestStep * 3) return false;
    newton_->Move(1, change);
    trial_fraction_ += change;
    if (size < kTolerance || (corrections_ > 0 && size < 1e-6)) return true;
  }
  return false;
}

bool LoadPath::Advance() {
  limit_fraction_ = 0;
  if (!has_tangent_ && !Tangent()) return false;
  for (; step_ > kSmallestStep; step_ *= 0.4) {
    Restore(start_ + step_ * tangent_);
    trial_fraction_ = fraction_ + step_ * tangent_fraction_;
    if (!Correct(step_)) continue;
    const double before = tangent_fraction_, from = fraction_;
    const Eigen::VectorXd tangent_before = tangent_;
    fraction_ = trial_fraction_;
    Eigen::VectorXd reached;
    Keep(&reached);
    if (!Tangent() ||
        // A sharp turn is a step onto something else.
        Dot(tangent_.data(), tangent_before.data()) +
                tangent_fraction_ * before <
            0.5) {
      fraction_ = from;
      tangent_ = tangent_before;
      tangent_fraction_ = before;
      Restore(start_);
      continue;
    }
    if (before > 0 && tangent_fraction_ < 0) {
      // lambda' falls linearly to zero at the limit point.
      limit_fraction_ =
          from + 0.5 * step_ * before * before / (before - tangent_fraction_);
      limit_fraction_ = std::max({limit_fraction_, from, fraction_});
    } else if (newton_->RefineMesh() &&
               !(newton_->Converge(contacts_, fraction_, SweepColumns::kLoad) &&
                 Tangent())) {
      return false;
    }
    Keep(&start_);
    if (corrections_ <= 3) step_ = std::min(kLargestStep, 1.5 * step_);
    return true;
  }
  Restore(start_);
  return false;
}

LoadPathEnd WalkLoadPath(const std::vector<PointContact>& contacts,
                         LadderNewton* newton, double* fraction) {
  newton->Reset();
  *fraction = 0;
  if (!newton->Converge(contacts, 0, SweepColumns::kLoad)) {
    return LoadPathEnd::kStuck;
  }
  LoadPath path(newton, contacts, 0);
  for (int i = 0; i < kMostSteps; ++i) {
    const bool advanced = path.Advance();
    *fraction = path.fraction();
    if (!advanced) return LoadPathEnd::kStuck;
    if (path.passed_limit_point() && path.limit_fraction() < 1) {
      *fraction = path.limit_fraction();
      return LoadPathEnd::kLimitPoint;
    }
    if (path.fraction() >= 1) {
      // Back along the tangent to the load itself.
      newton->Move(0, (1 - path.fraction()));
      return LoadPathEnd::kReached;
    }
  }
  return LoadPathEnd::kStuck;
}

}  // namespace finray
