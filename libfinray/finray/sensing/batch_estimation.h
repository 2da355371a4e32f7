#ifndef FINRAY_SENSING_BATCH_ESTIMATION_H_
#define FINRAY_SENSING_BATCH_ESTIMATION_H_

#include <vector>

#include "finray/io/frame_table.h"
#include "finray/sensing/estimation_summary.h"

namespace finray {

/// Estimates all frames, in blocks at fixed places
/// (FrameSolverPool), so that the results do not depend on `threads`.
std::vector<FrameEstimate> EstimateFrames(
    const Finger& finger, const Scene& scene,
    const Discretization& discretization,
    const std::vector<FrameReadings>& readings, int threads);

/// Estimates every row of a log from gauge_<j>_V (from gauge_<j>_rad where that
/// is all there is) and fills in contact_1_*, normal_1_*, friction_1, gauge
/// angles, ribs, tip, chi2, iterations and status. The log's own contact
/// columns, if any, are overwritten, not used. Throws InputError if a gauge of
/// the finger has no column.
EstimationSummary EstimateLog(const Finger& finger, const Scene& scene,
                              const Discretization& discretization, int threads,
                              FrameTable* log);

}  // namespace finray

#endif  // FINRAY_SENSING_BATCH_ESTIMATION_H_
