#ifndef FINRAY_SENSING_LIVE_ESTIMATOR_H_
#define FINRAY_SENSING_LIVE_ESTIMATOR_H_

#include "finray/sensing/frame_estimator.h"

namespace finray {

/// Estimates frames as they arrive, each before the next one, for control loops
/// and displays (docs/guides/sense_live.md). Use it from one thread at a time.
class LiveEstimator {
 public:
  /// Throws the errors of FrameEstimator. Takes some milliseconds.
  LiveEstimator(const Finger& finger, const Scene& scene,
                const Discretization& discretization = {},
                FrameMethod method = FrameMethod::kFast);

  /// Estimates the contact from these readings. The result is valid until the
  /// next call.
  const FrameEstimate& Next(const Measurements& readings);

  /// The next frame starts another log.
  void Restart() { estimator_.StopFollowing(); }

 private:
  FrameEstimator estimator_;
  FrameEstimate estimate_;
};

}  // namespace finray

#endif  // FINRAY_SENSING_LIVE_ESTIMATOR_H_
