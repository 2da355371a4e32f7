#ifndef FINRAY_SENSING_LIVE_ESTIMATOR_H_
#define FINRAY_SENSING_LIVE_ESTIMATOR_H_

#include "finray/sensing/frame_estimator.h"

namespace finray {

/// Frames as they come, each estimated before the next one is there. For
/// control loops and displays (docs/guides/sense_live.md); one thread at
/// a time.
class LiveEstimator {
 public:
  /// Throws what FrameEstimator throws. Takes some milliseconds.
  LiveEstimator(const Finger& finger, const Scene& scene,
                const Discretization& discretization = {},
                FrameMethod method = FrameMethod::kFast);

  /// The contact of these readings; it lives until the next call.
  const FrameEstimate& Next(const Measurements& readings);

  /// The next frame is the first one of another log.
  void Restart() { estimator_.StopFollowing(); }

 private:
  FrameEstimator estimator_;
  FrameEstimate estimate_;
};

}  // namespace finray

#endif  // FINRAY_SENSING_LIVE_ESTIMATOR_H_
