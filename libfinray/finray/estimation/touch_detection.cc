#include "finray/estimation/touch_detection.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "finray/estimation/chi_squared.h"
#include "finray/estimation/frame_estimator.h"
#include "finray/finger/geometry.h"

namespace finray {
namespace {

// The free finger could have given readings of this p-value or more, a contact
// has given those of this one.
constexpr double kCouldBeFree = 1e-3, kExplained = 1e-4;
// A contact also explains what it leaves so small a share of. Fingers differ
// from their model by a percent, which is many std of a reading under load.
constexpr double kLeftOver = 0.2;
// The largest force unless the scene says so, in EI / l_0^2. A fit that needs
// more than is credible still says that something touches.
constexpr double kDetectedForce = 160;
// The guard has this many frames at least.
constexpr std::size_t kLeastGuard = 2;

std::size_t At(std::size_t i, std::size_t count, bool forward) {
  return forward ? i : count - 1 - i;
}

Scene WithAnyForce(Scene scene, const Finger& finger) {
  if (!scene.force_max_N) {
    scene.force_max_N = kDetectedForce * ForceUnit(finger);
  }
  // Whole logs are not live.
  scene.search_iteration_limit.reset();
  return scene;
}

}  // namespace

TouchDetection::TouchDetection(const Finger& finger, const Scene& scene,
                               const Discretization& discretization)
    : finger_(finger),
      scene_(scene),
      walk_(scene.gauge_offset_walk
                ? std::pow(scene.gauge_offset_walk->std_V_per_sqrt_s, 2)
                : 0),
      search_(finger, WithAnyForce(scene, finger), discretization) {
  if (walk_ > 0) guard_s_ = GuardTime_s(finger, *scene.gauge_offset_walk);
}

double TouchDetection::GuardTime_s(const Finger& finger,
                                   const GaugeOffsetWalk& walk) {
  double guard_s = kLongestGuard_s;
  for (const Gauge& gauge : finger.gauges) {
    guard_s = std::min(
        guard_s, std::pow(kGuard * gauge.noise_V / walk.std_V_per_sqrt_s, 2));
  }
  return guard_s;
}

void TouchDetection::Decide(const OffsetBelief& before,
                            std::vector<LogFrame>* frames) {
  std::vector<LogFrame>& all = *frames;
  const std::vector<Verdict> there = Pass(all, before, nullptr);
  std::vector<Verdict> back = there;
  if (walk_ > 0) {
    back = Pass(all, Behind(before, all), &there);
  }
  for (std::size_t t = 0; t < all.size(); ++t) {
    const auto either = [&](Verdict verdict) {
      return there[t] == verdict || back[t] == verdict;
    };
    all[t].role = either(Verdict::kTouching) ? LogFrame::Role::kTouching
                  : either(Verdict::kGuard)  ? LogFrame::Role::kUnused
                  : either(Verdict::kFree)   ? LogFrame::Role::kFree
                                             : LogFrame::Role::kUnused;
    all[t].doubtful =
        all[t].role == LogFrame::Role::kUnused && either(Verdict::kDoubtful);
  }
  Start(before, &all);
}

// What is known of the offsets of the last frame before any is looked at.
OffsetBelief TouchDetection::Behind(const OffsetBelief& before,
                                    const std::vector<LogFrame>& frames) const {
  OffsetBelief behind = before;
  behind.Wander(frames.back().row.time_s, walk_);
  return behind;
}

std::vector<TouchDetection::Verdict> TouchDetection::Pass(
    const std::vector<LogFrame>& frames, OffsetBelief belief,
    const std::vector<Verdict>* there) {
  const bool forward = there == nullptr;
  const Eigen::VectorXd& angles = search_.table().free_angles();
  std::vector<Verdict> verdicts(frames.size());
  HeldTouch touch = forward ? before_ : HeldTouch();
  Eigen::VectorXd beside_V;
  bool known = forward;  // where the offsets are
  if (forward) touches_.clear();
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (forward) touches_.push_back(touch);
    const std::size_t t = At(i, frames.size(), forward);
    const LogFrame& frame = frames[t];
    OffsetBelief here = belief;
    here.Wander(frame.row.time_s, walk_);
    ReadBesideFree(finger_, angles, frame.row, &beside_V);
    if (FindContact(frame, here.mean_V, here.variance_V2)) {
      const double chi2 = search_.best().chi2;
      const bool explained =
          chi2 < kLeftOver * measurement_.free_chi2 || measurement_.all < 3 ||
          ChiSquaredTail(chi2, measurement_.all - 2) > kExplained;
      verdicts[t] = explained ? Verdict::kTouching : Verdict::kUnexplained;
      if (explained && walk_ > 0) touch.Hold(beside_V, frame.row.time_s);
      continue;
    }
    known = known || (*there)[t] == Verdict::kFree;
    if (!known || touch.Lasts(finger_, beside_V, here.mean_V)) {
      verdicts[t] = Verdict::kDoubtful;
      if (known) touch.Hold(beside_V, frame.row.time_s);
      continue;
    }
    here.Absorb(finger_, angles, frame.row);
    if (CouldStayFree(frames, i, here, forward)) {
      belief = here;
      verdicts[t] = Verdict::kFree;
      touch.End();
    } else {
      verdicts[t] = Verdict::kGuard;
    }
  }
  return verdicts;
}

bool TouchDetection::CouldStayFree(const std::vector<LogFrame>& frames,
                                   std::size_t first,
                                   const OffsetBelief& belief,
                                   bool forward) const {
  for (std::size_t i = first + 1; i < frames.size(); ++i) {
    const LogFrame& frame = frames[At(i, frames.size(), forward)];
    const bool close = std::abs(frame.row.time_s - belief.time_s) <= guard_s_;
    if (walk_ == 0 || (!close && i > first + kLeastGuard)) break;
    OffsetBelief here = belief;
    here.Wander(frame.row.time_s, walk_);
    const double chi2 = FreeChi2(frame, here.mean_V, here.variance_V2);
    const auto gauges = static_cast<int>(finger_.gauges.size());
    if (ChiSquaredTail(chi2, gauges) < kCouldBeFree) return false;
  }
  return true;
}

std::vector<OffsetBelief> TouchDetection::Beliefs(
    const OffsetBelief& before, const std::vector<LogFrame>& frames) const {
  std::vector<OffsetBelief> beliefs = FromOneSide(frames, before, true);
  if (walk_ == 0) return beliefs;
  const std::vector<OffsetBelief> back =
      FromOneSide(frames, Behind(before, frames), false);
  for (std::size_t t = 0; t < frames.size(); ++t) {
    OffsetBelief& here = beliefs[t];
    const Eigen::ArrayXd share =
        here.variance_V2.array() /
        (here.variance_V2 + back[t].variance_V2).array();
    here.mean_V.array() += share * (back[t].mean_V - here.mean_V).array();
    here.variance_V2.array() = share * back[t].variance_V2.array();
  }
  return beliefs;
}

// Starts: offsets from the free frames on both sides, contacts from a search
// with these.
void TouchDetection::Start(const OffsetBelief& before,
                           std::vector<LogFrame>* frames) {
  const std::vector<OffsetBelief> beliefs = Beliefs(before, *frames);
  for (std::size_t t = 0; t < frames->size(); ++t) {
    LogFrame& frame = (*frames)[t];
    const OffsetBelief& here = beliefs[t];
    frame.offset_V = here.mean_V;
    if (frame.role != LogFrame::Role::kTouching) continue;
    if (FindContact(frame, here.mean_V, here.variance_V2)) {
      StartTouch(&frame);
    } else {
      frame.LeaveOpen();
    }
  }
}

void TouchDetection::StartTouch(LogFrame* frame) const {
  const ContactSolution* first = &search_.best();
  const ContactSolution* second = search_.rival();
  if (second != nullptr &&
      first->contacts[0].normal_N > kHeavier * second->contacts[0].normal_N) {
    std::swap(first, second);
  }
  frame->role = LogFrame::Role::kTouching;
  frame->doubtful = false;
  frame->arc_mm = first->contacts[0].arc_mm;
  frame->normal_N = first->contacts[0].normal_N;
  frame->state = search_.table().StateNear(frame->arc_mm, frame->normal_N);
  frame->rival.reset();
  if (second == nullptr) return;
  frame->rival = {*second, second->chi2 - first->chi2};
}

// The offsets of each frame as the free frames on one side of it tell them.
std::vector<OffsetBelief> TouchDetection::FromOneSide(
    const std::vector<LogFrame>& frames, OffsetBelief belief,
    bool forward) const {
  std::vector<OffsetBelief> beliefs(frames.size());
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const std::size_t t = At(i, frames.size(), forward);
    belief.Wander(frames[t].row.time_s, walk_);
    beliefs[t] = belief;
    if (frames[t].role == LogFrame::Role::kFree) {
      belief.Absorb(finger_, search_.table().free_angles(), frames[t].row);
    }
  }
  return beliefs;
}

bool TouchDetection::FindContact(const LogFrame& frame,
                                 const Eigen::VectorXd& mean_V,
                                 const Eigen::VectorXd& variance_V2) {
  OffsetBelief belief;
  belief.mean_V = mean_V;
  belief.variance_V2 = variance_V2;
  MoveToOffsetsOf(finger_, belief, frame.row, &moved_);
  Pack(finger_, scene_, moved_, &measurement_);
  const double free_chi2 = FreeChi2(frame, mean_V, variance_V2);
  measurement_.free_chi2 = free_chi2;
  if (measurement_.all < 2 || scene_.contacts == 0) return false;
  search_.Begin(moved_);
  if (scene_.contacts) return search_.Search(1, measurement_);
  return free_chi2 >= FrameEstimator::kSignificance &&
         search_.Search(1, measurement_) &&
         free_chi2 - search_.best().chi2 >= FrameEstimator::kSignificance;
}

double TouchDetection::FreeCameraChi2(const Measurements& row) {
  Measurements camera = row;
  camera.gauges_V.assign(row.gauges_V.size(), Measurements::kNotMeasured);
  return search_.FreeChi2(camera);
}

double TouchDetection::FreeChi2(const LogFrame& frame,
                                const Eigen::VectorXd& mean_V,
                                const Eigen::VectorXd& variance_V2) const {
  const Eigen::VectorXd& free = search_.table().free_angles();
  double chi2 = 0;
  for (std::size_t j = 0; j < finger_.gauges.size(); ++j) {
    if (!finger_.gauges[j].IsMeasured(frame.row.gauges_V[j])) continue;
    const Gauge& gauge = finger_.gauges[j];
    const double off =
        frame.row.gauges_V[j] - gauge.BendingVolts(free[j]) - mean_V[j];
    chi2 +=
        off * off /
        (variance_V2[j] + std::pow(frame.row.GaugeStd_V(j, gauge.noise_V), 2));
  }
  return chi2;
}

}  // namespace finray
