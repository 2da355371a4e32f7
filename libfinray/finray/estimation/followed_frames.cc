#include <algorithm>

#include "finray/estimation/frame_estimator.h"
#include "finray/estimation/smoothing.h"

// Frames that follow each other: blocks of a log, and frames that come one by
// one.

namespace finray {
namespace {

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
    if (!SearchNext(readings[i], packed_[i], &estimates[i])) {
      // Another explanation may have been there while frames were followed.
      if (doubtful_ < kDoubtful) searched = i;
      for (; searched < i; ++searched) {
        SearchAlone(readings[searched], packed_[searched],
                    &estimates[searched]);
      }
      searched = i + 1;
    }
    ++i;
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

const FrameEstimate& FrameEstimator::Next(const Measurements& readings) {
  if (offsets_) {
    NextAlone(offsets_->Correct(readings));
    offsets_->Judge(&next_);
  } else {
    NextAlone(readings);
  }
  return next_;
}

void FrameEstimator::NextAlone(const Measurements& readings) {
  if (Slides(readings)) {
    LeaveLastFrame();
    next_ = EstimateSliding(readings);
    return;
  }
  PackAll(&readings, 1);
  SearchNext(readings, packed_[0], &next_);
  if (scene_.smoothing) {
    followed_ = SmoothBlock(&readings, 1, followed_, &next_);
  } else {
    Judge(readings, packed_[0], &next_);
  }
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
  search_.Begin(readings);
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

}  // namespace finray
