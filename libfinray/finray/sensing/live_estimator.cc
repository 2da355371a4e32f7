#include "finray/sensing/live_estimator.h"

namespace finray {

LiveEstimator::LiveEstimator(const Finger& finger, const Scene& scene,
                             const Discretization& discretization,
                             FrameMethod method)
    : estimator_(finger, scene, discretization, method) {}

const FrameEstimate& LiveEstimator::Next(const Measurements& readings) {
  estimate_ = estimator_.Follow(readings);
  return estimate_;
}

}  // namespace finray
