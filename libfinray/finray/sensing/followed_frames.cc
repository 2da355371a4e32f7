#include <algorithm>
#include <cmath>

#include "finray/io/nan.h"
#include "finray/sensing/frame_estimator.h"
#include "finray/sensing/smoothing.h"

// Frames that follow each other: blocks of a log, and frames that come one by
// one.

namespace finray {
namespace {

double ArcStd(const ContactMatrix& information) {
  return std::sqrt(CovarianceOf(information)(0, 0));
}

// Two contacts are not followed for so many frames after a frame that might
// have another explanation: noise shows it in some frames and hides it in
// others.
constexpr int kDoubtful = 64;

}  // namespace

void FrameEstimator::EstimateBlock(const Measurements* readings,
                                   std::size_t count,
                                   FrameEstimate* estimates) {
  PackAll(readings, count);
  LeaveLastFrame();          // that of Next()
  std::size_t searched = 0;  // all frames before are, or have one contact
  for (std::size_t i = 0; i < count;) {
    if (Slides(readings[i])) {
      LeaveLastFrame();
      searched = ++i;
      continue;
    }
    const bool followed = SearchNext(readings[i], packed_[i], &estimates[i]);
    const bool follow = CanFollow(packed_[i], estimates[i]);
    if (!followed) {
      // Another explanation may have been there while frames were followed.
      if (doubtful_ < kDoubtful) searched = i;
      for (; searched < i; ++searched) {
        SearchAlone(readings[searched], packed_[searched],
                    &estimates[searched]);
      }
      searched = i + 1;
    }
    ++i;
    if (!follow) continue;
    std::size_t end = i;
    while (end < count && !Slides(readings[end])) ++end;
    const std::size_t fitted = FitRun(i, end);
    for (std::size_t run = 0; run < fitted; ++run, ++i) {
      if (!TakeFollowed(packed_[i], run, &estimates[i])) {
        SearchAlone(readings[i], packed_[i], &estimates[i]);
      }
    }
    searched = i;
  }
  if (scene_.smoothing) {
    SmoothBlock(readings, count, {}, estimates);
    return;
  }
  for (std::size_t i = 0; i < count; ++i) {
    if (!Slides(readings[i])) Judge(readings[i], packed_[i], &estimates[i]);
  }
  // These use the memory of the packed frames.
  for (std::size_t i = 0; i < count; ++i) {
    if (Slides(readings[i])) estimates[i] = EstimateSliding(readings[i]);
  }
}

FrameEstimate FrameEstimator::Next(const Measurements& readings) {
  if (!offsets_) return NextAlone(readings);
  // The map of rivals is that of the noise, without errors of the offsets.
  following_ = false;
  FrameEstimate estimate = NextAlone(offsets_->Correct(readings));
  offsets_->Judge(&estimate);
  return estimate;
}

FrameEstimate FrameEstimator::NextAlone(const Measurements& readings) {
  if (Slides(readings)) {
    LeaveLastFrame();
    return EstimateSliding(readings);
  }
  FrameEstimate estimate;
  PackAll(&readings, 1);
  if (!following_ || FitRun(0, 1) == 0 ||
      !TakeFollowed(packed_[0], 0, &estimate)) {
    SearchNext(readings, packed_[0], &estimate);
    following_ = CanFollow(packed_[0], estimate);
  }
  if (scene_.smoothing) {
    followed_ = SmoothBlock(&readings, 1, followed_, &estimate);
  } else {
    Judge(readings, packed_[0], &estimate);
  }
  return estimate;
}

bool FrameEstimator::SearchNext(const Measurements& readings,
                                const PackedReadings& packed,
                                FrameEstimate* estimate) {
  const bool all = packed.gauges == static_cast<int>(finger_.gauges.size());
  const auto is_sure = [&] {
    return estimate->contacts == 2 &&
           StatusOf(*estimate, finger_, search_) == FrameStatus::kOk;
  };
  bool doubtful = false;
  search_.Begin();
  if (follows_two_ && all) {
    following_two_ = true;
    Explain(readings, packed, estimate);
    following_two_ = false;
    // A search is exact to rounding, which this is not.
    const bool noiseless =
        estimate->dof > 0 && estimate->chi2 < ContactSearch::kNoiseless;
    if (is_sure() && !noiseless) return true;
    doubtful = search_.HasSuspect();
    // Nothing is left to search with.
    if (search_.ended() && estimate->contacts > 0) {
      follows_two_ = false;
      return false;
    }
  }
  Explain(readings, packed, estimate);
  follows_two_ = all && is_sure() && search_.BeginFollowing();
  doubtful |= estimate->contacts == 2 && search_.HasSuspect();
  doubtful_ = doubtful ? kDoubtful : std::max(0, doubtful_ - 1);
  follows_two_ &= doubtful_ == 0;
  return false;
}

LogPrior FrameEstimator::SmoothBlock(const Measurements* readings,
                                     std::size_t count, const LogPrior& before,
                                     FrameEstimate* estimates) {
  std::vector<char> sure(count);
  for (std::size_t i = 0; i < count; ++i) {
    sure[i] = StatusOf(estimates[i], finger_, search_) == FrameStatus::kOk;
  }
  const LogPrior next = Smooth(finger_, scene_, discretization_, readings,
                               count, before, estimates, &sure);
  for (std::size_t i = 0; i < count; ++i) {
    Judge(readings[i], packed_[i], &estimates[i]);
    if (estimates[i].contacts == 1 && !sure[i]) {
      estimates[i].status = FrameStatus::kUnobservable;
    }
  }
  return next;
}

// Says whether later frames can be followed from the frame searched last.
bool FrameEstimator::CanFollow(const PackedReadings& packed,
                               const FrameEstimate& estimate) {
  return follower_ && estimate.contacts == 1 && !estimate.valley &&
         StatusOf(estimate, finger_, search_) == FrameStatus::kOk &&
         follower_->Start(search_.best(), ArcStd(search_.best().information),
                          packed.gauges);
}

// Fits the packed frames [begin, end) up to the first that lacks a gauge or a
// contact. Returns their number.
std::size_t FrameEstimator::FitRun(std::size_t begin, std::size_t end) {
  const auto all = static_cast<int>(finger_.gauges.size());
  std::size_t stop = begin;
  while (stop < end && packed_[stop].gauges == all &&
         packed_[stop].free_chi2 >= kSignificance) {
    ++stop;
  }
  if (stop > begin) follower_->Fit(&packed_[begin], stop - begin);
  return stop - begin;
}

// Takes the follower's fit for its frame number `run`, if a search would find
// the same.
bool FrameEstimator::TakeFollowed(const PackedReadings& packed, std::size_t run,
                                  FrameEstimate* estimate) {
  const ContactSolution& fit = follower_->fit(run);
  if (fit.count == 0) return false;
  const PointContact& contact = fit.contacts[0];
  estimate->chi2 = fit.chi2;
  estimate->model_chi2 = kNaN;
  estimate->dof = static_cast<int>(finger_.gauges.size()) - kUnknowns;
  // A search is exact to rounding, which this is not.
  if (estimate->dof > 0 && fit.chi2 < ContactSearch::kNoiseless) return false;
  // A search weighs the errors of the calibration, which this does not.
  const double scale = estimate->noise_scale();
  if (scale > 1 && !systematic_.empty()) return false;
  const ContactMatrix covariance = CovarianceOf(fit.information);
  const double arc_std = scale * std::sqrt(covariance(0, 0));
  const bool alone = scene_.most_contacts < 2 || fit.chi2 < kSecondSignificance;
  const bool touches =
      scene_.contacts ? contact.normal_N >= least_force_N_
                      : alone && packed.free_chi2 - fit.chi2 >= kSignificance;
  if (!touches || !follower_->IsCertain(run, arc_std, scale)) {
    return false;
  }
  estimate->contacts = 1;
  estimate->contact[0] = {contact.arc_mm, arc_std, contact.normal_N,
                          scale * std::sqrt(covariance(1, 1)), fit.poses[0]};
  estimate->contact[1] = {};
  estimate->valley.reset();
  estimate->noise_covariance = covariance;
  estimate->alternative = {};
  estimate->alternative_chi2 = kNaN;
  estimate->tip_pose = fit.tip_pose;
  estimate->rib_tension_N = fit.rib_tension_N;
  estimate->iterations = 1;
  estimate->search_ended = false;
  return true;
}

}  // namespace finray
