#include "finray/sensing/fast/lane_group_fit.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "finray/ladder/mesh_refinement.h"
#include "finray/ladder/rib_law.h"
#include "finray/sensing/gauge_surface.h"

namespace finray {
namespace {

// Frames that take more iterations, or begin with a larger change, are fitted
// alone.
constexpr int kMostIterations = 10;
constexpr double kLargestChange = 0.5;

template <class T>
ContactVector OfLane(const T values[2], int lane) {
  return Eigen::Vector2d(values[0][lane], values[1][lane]);
}

}  // namespace

template <class T>
LaneGroupFit<T>::LaneGroupFit(const Finger& finger,
                              const Discretization& discretization,
                              double friction)
    : lanes_(finger, discretization, friction),
      alone_(finger, discretization),
      friction_(friction),
      adaptive_(discretization.adaptive()),
      gauges_(lanes_.model().gauges()),
      kept_state_(lanes_.frame().state_size()),
      contact_(1) {}

template <class T>
void LaneGroupFit<T>::set_tolerance(double relative) {
  tolerance_ = relative;
  alone_.set_tolerance(relative);
}

template <class T>
void LaneGroupFit<T>::set_most_force(double force_N) {
  most_force_N_ = force_N;
  alone_.set_most_force(force_N);
}

template <class T>
void LaneGroupFit<T>::set_surface(const GaugeSurface* surface) {
  surface_ = surface;
}

template <class T>
void LaneGroupFit<T>::Start(const LadderState& state,
                            const PointContact& contact) {
  fresh_ = true;
  state_ = state;
  contact_[0] = {contact.arc_mm, contact.normal_N, friction_};
  alone_.set_state(state);
}

template <class T>
void LaneGroupFit<T>::StartLanes() {
  fresh_ = one_by_one_ = false;
  linearised_ = 0;
  newton_ = change_[0] = change_[1] = T{};
  for (int lane = 0; lane < kLanes; ++lane) {
    one_by_one_ |= !lanes_.Load(state_, lane);
    lane_[lane].arc_mm = contact_[0].arc_mm;
    lane_[lane].normal_N = contact_[0].normal_N;
  }
}

template <class T>
void LaneGroupFit<T>::Fit(const Columns& angles_rad,
                          const Columns& weights_per_rad, FrameFit* fits) {
  const Frames frames{angles_rad, weights_per_rad, fits};
  // A log that comes frame by frame would leave all lanes but one empty.
  if (fresh_ && frames.count() == 1) return FitAlone(frames, 0);
  if (fresh_) StartLanes();
  next_ = 0;
  for (int lane = 0; lane < kLanes; ++lane) TakeFrame(lane);
  for (int lane = 0; lane < kLanes; ++lane) Begin(frames, lane);
  const auto busy = [&](const Lane& lane) { return frames.Busy(lane); };
  while (!one_by_one_ && std::any_of(lane_.begin(), lane_.end(), busy)) {
    Keep(to_keep_);
    if (linearised_ != 0) lanes_.Step(newton_, change_);
    Linearize(frames);
    for (int lane = 0; lane < kLanes; ++lane) {
      if (frames.Busy(lane_[lane])) Advance(frames, lane);
    }
  }
  if (!one_by_one_) return;
  for (int i = 0; i < frames.count(); ++i) {
    const auto has = [i](const Lane& lane) { return lane.frame == i; };
    if (i >= next_ || std::any_of(lane_.begin(), lane_.end(), has)) {
      FitAlone(frames, i);
    }
  }
}

template <class T>
void LaneGroupFit<T>::TakeFrame(int lane) {
  Lane& l = lane_[lane];
  l.frame = next_++;
  l.iteration = 0;
  l.has_curvatures = false;
  l.last_cost = std::numeric_limits<double>::infinity();
  l.last_change = kUnknownChange;
  l.kept_arc_mm = l.arc_mm;
  l.kept_normal_N = l.normal_N;
  to_keep_ |= 1u << lane;
}

// Predicts the contact of the lane's frame if there is a linearisation to
// predict from.
template <class T>
void LaneGroupFit<T>::Begin(const Frames& frames, int lane) {
  Lane& l = lane_[lane];
  if (one_by_one_ || !frames.Busy(l)) return;
  if (Has(linearised_, lane) && !Improve(frames, lane, true)) {
    FitLane(frames, lane);
  }
}

// Linearises all lanes. Lanes without a frame move along, so that they are near
// the start of their next one.
template <class T>
void LaneGroupFit<T>::Linearize(const Frames& frames) {
  std::array<double, kLanes> arc_mm, normal_N;
  LaneSet first = 0;
  for (int lane = 0; lane < kLanes; ++lane) {
    arc_mm[lane] = lane_[lane].arc_mm;
    normal_N[lane] = lane_[lane].normal_N;
    if (frames.Busy(lane_[lane])) first |= 1u << lane;
  }
  comparable_ = linearised_;
  linearised_ = lanes_.Place(arc_mm, normal_N, kAllFrameLanes<T>, first);
  if (!lanes_.Linearize()) {
    // One bad lane spoils the linearisation of all. The states are restored so
    // that idle lanes do not spoil the next one too.
    linearised_ = 0;
    T* state = lanes_.frame().state.q;
    std::copy(kept_state_.begin(), kept_state_.end(), state);
  }
  for (int k = 0; k < 2; ++k) {
    step_[k] = change_[k];
    change_[k] = T{};
  }
  for (int lane = 0; lane < kLanes; ++lane) {
    newton_[lane] = Has(linearised_, lane);
  }
  gauges_.Read(lanes_.frame(), 2);
}

// Called after a linearisation. If the lane's frame has converged, records it
// and predicts the next one.
template <class T>
void LaneGroupFit<T>::Advance(const Frames& frames, int lane) {
  Lane& l = lane_[lane];
  if (one_by_one_) return;
  if (!Has(linearised_, lane) || ++l.iteration > kMostIterations ||
      !Improve(frames, lane, false) ||
      (l.converged && adaptive_ && !IsResolved(lanes_.frame(), lane)) ||
      (l.converged && BendsTooFar(lanes_.frame(), lane))) {
    FitLane(frames, lane);
    return;
  }
  if (!l.converged) return;
  Record(frames, lane);
  TakeFrame(lane);
  Begin(frames, lane);
}

// Moves the contact to the least squares of the linearisation. Returns false if
// the frame should be fitted alone.
template <class T>
bool LaneGroupFit<T>::Improve(const Frames& frames, int lane, bool predict) {
  Lane& l = lane_[lane];
  const double length = lanes_.workspace().length_unit();
  const double force = lanes_.workspace().force_unit();
  const Column measured = frames.angles_rad.col(l.frame);
  const Column weights = frames.weights_per_rad.col(l.frame);
  ContactVector x(2);
  x << l.arc_mm / length, l.normal_N / force;
  if (surface_ && !l.has_curvatures && surface_->Covers(x[1])) {
    surface_->CurvaturesAt(x[0], x[1], &l.curvatures);
    l.has_curvatures = true;
  }
  const GaugeCurvatures* const curvatures =
      l.has_curvatures ? &l.curvatures : nullptr;
  const ContactEquations equations =
      gauges_.Equations(measured, weights, curvatures, 2, lane);
  // This comparison and those below are written so that a NaN fails them.
  if (!(equations.chi2 <= kMostRise * l.last_cost + 1)) return false;
  l.last_cost = equations.chi2;
  l.normal = equations.normal;
  const ContactVector change =
      gauges_.Change(measured, weights, curvatures, equations, x,
                     most_force_N_ / force, 0, lane);
  const double moved =
      LargestChange(change, x, ShapeChange(lane, !predict, change));
  if (!(moved <= kLargestChange)) return false;
  const bool crossed =
      MoveContact(lanes_.model().mesh(Side::kFront), change.data(), length,
                  force, &l.arc_mm, &l.normal_N);
  for (int k = 0; k < 2; ++k) change_[k][lane] += change[k];
  gauges_.Move(change, lane);
  if (predict) {
    l.converged = false;
  } else {
    const double rate = Has(comparable_, lane)
                            ? gauges_.Rate(measured, weights, equations, 0,
                                           OfLane(step_, lane), x, lane)
                            : 0;
    l.converged = IsLastChange(moved, l.last_change, rate, crossed, tolerance_);
  }
  l.last_change = moved;
  return true;
}

// The change of the whole shape, judged by the gaps between its elements and by
// the poses of tip and contact.
template <class T>
double LaneGroupFit<T>::ShapeChange(int lane, bool newton,
                                    const ContactVector& change) const {
  const LadderFrame<T>& f = lanes_.frame();
  double largest = newton ? f.residual[lane] : 0;
  for (const int first :
       {f.tip_tap(), f.contact_tap(lanes_.contact_of(lane))}) {
    for (int tap = first; tap < first + 3; ++tap) {
      const T* row = f.taps + tap * f.stride + f.affine;
      largest = std::max(largest, std::abs((newton ? row[0][lane] : 0) +
                                           row[1][lane] * change[0] +
                                           row[2][lane] * change[1]));
    }
  }
  return largest;
}

// Writes a converged lane's result to its frame. Poses and rib tensions are
// those of the last linearisation plus their linear change in the last step.
template <class T>
void LaneGroupFit<T>::Record(const Frames& frames, int lane) const {
  const LadderFrame<T>& f = lanes_.frame();
  const Lane& l = lane_[lane];
  FrameFit& fit = frames.fits[l.frame];
  const double length = lanes_.workspace().length_unit();
  const double force = lanes_.workspace().force_unit();
  fit.converged = fit.in_lanes = true;
  fit.iterations = l.iteration;
  fit.arc_mm = l.arc_mm;
  fit.normal_N = l.normal_N;
  fit.information = InformationOf(l.normal, length, force);
  fit.chi2 = gauges_.Chi2(frames.angles_rad.col(l.frame),
                          frames.weights_per_rad.col(l.frame), lane);
  const ContactVector change = OfLane(change_, lane);
  fit.contact_pose =
      PoseAfter(f, lanes_.contact_of(lane), length, change, lane);
  fit.tip_pose = PoseAfter(f, f.contact_count, length, change, lane);
  fit.rib_tension_N.resize(f.ribs);
  for (int i = 0; i < f.ribs; ++i) {
    fit.rib_tension_N[i] =
        force * (f.state.q[6 + i][lane] +
                 ChangeOf(f, f.q_step + (6 + i) * f.stride, change, lane));
  }
}

template <class T>
void LaneGroupFit<T>::Keep(LaneSet lanes) {
  const T* state = lanes_.frame().state.q;
  if (lanes == kAllFrameLanes<T>) {
    std::copy_n(state, kept_state_.size(), kept_state_.begin());
  } else {
    for (int lane = 0; lane < kLanes; ++lane) {
      if (!Has(lanes, lane)) continue;
      for (std::size_t i = 0; i < kept_state_.size(); ++i) {
        kept_state_[i][lane] = state[i][lane];
      }
    }
  }
  to_keep_ &= ~lanes;
}

// Fits a lane's frame without the other lanes, from where the frame started.
template <class T>
void LaneGroupFit<T>::FitLane(const Frames& frames, int lane) {
  Lane& l = lane_[lane];
  Keep(to_keep_ & 1u << lane);
  T* state = lanes_.frame().state.q;
  for (std::size_t i = 0; i < kept_state_.size(); ++i) {
    state[i][lane] = kept_state_[i][lane];
  }
  l.arc_mm = l.kept_arc_mm;
  l.normal_N = l.kept_normal_N;
  linearised_ &= ~(1u << lane);
  newton_[lane] = change_[0][lane] = change_[1][lane] = 0;

  lanes_.Save(&state_, lane);
  alone_.set_state(state_);
  contact_[0] = {l.arc_mm, l.normal_N, friction_};
  FitAlone(frames, l.frame);
  const FrameFit& fit = frames.fits[l.frame];
  if (fit.converged) {
    one_by_one_ = !lanes_.Load(state_, lane);
    l.arc_mm = fit.arc_mm;
    l.normal_N = fit.normal_N;
  }
  TakeFrame(lane);
}

// Fits a frame by ContactFit, starting from state_ and contact_.
template <class T>
void LaneGroupFit<T>::FitAlone(const Frames& frames, int frame) {
  FrameFit& fit = frames.fits[frame];
  const PointContact before = contact_[0];
  fit.in_lanes = false;
  fit.converged = alone_.Follow(frames.angles_rad.col(frame),
                                frames.weights_per_rad.col(frame), &contact_);
  fit.iterations = alone_.iterations();
  if (!fit.converged) {
    alone_.set_state(state_);
    contact_[0] = before;
    return;
  }
  alone_.SaveState(&state_);
  fit.arc_mm = contact_[0].arc_mm;
  fit.normal_N = contact_[0].normal_N;
  fit.chi2 = alone_.chi2();
  fit.information = alone_.information();
  fit.contact_pose = alone_.contact_pose(0);
  fit.tip_pose = alone_.tip_pose();
  fit.rib_tension_N.resize(lanes_.model().ribs());
  for (int i = 0; i < lanes_.model().ribs(); ++i) {
    fit.rib_tension_N[i] = alone_.rib_tension(i);
  }
}

std::unique_ptr<FrameGroupFit> FrameGroupFit::Make(
    const Finger& finger, const Discretization& discretization, double friction,
    int lanes) {
  if (lanes == kFrameLanes<EightFrames>) {
    return std::make_unique<LaneGroupFit<EightFrames>>(finger, discretization,
                                                       friction);
  }
  if (lanes != kFrameLanes<FourFrames>) {
    throw std::invalid_argument("frames go in 4 or 8 lanes");
  }
  return std::make_unique<LaneGroupFit<FourFrames>>(finger, discretization,
                                                    friction);
}

}  // namespace finray
