#ifndef FINRAY_BATCH_BATCH_ESTIMATION_H_
#define FINRAY_BATCH_BATCH_ESTIMATION_H_

#include <vector>

#include "finray/finger/finger.h"
#include "finray/scene/measurements.h"
#include "finray/scene/scene.h"
#include "finray/sensing/frame_estimate.h"

namespace finray {

/// Estimates all frames. Blocks lie at fixed places (FrameSolverPool), so the
/// results do not depend on `threads`.
std::vector<FrameEstimate> EstimateFrames(
    const Finger& finger, const Scene& scene,
    const Discretization& discretization,
    const std::vector<Measurements>& readings, int threads);

}  // namespace finray

#endif  // FINRAY_BATCH_BATCH_ESTIMATION_H_
