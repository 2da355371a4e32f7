#ifndef FINRAY_SENSING_BATCH_ESTIMATION_H_
#define FINRAY_SENSING_BATCH_ESTIMATION_H_

#include <array>
#include <vector>

#include "finray/io/frame_table.h"
#include "finray/sensing/frame_estimator.h"

namespace finray {

/// How a log came out.
struct EstimationSummary {
  std::size_t frames = 0;
  std::array<std::size_t, 5> by_status{};  ///< indexed by FrameStatus
  /// Against the log's own force_N, where it has one and the frame was solved.
  std::size_t force_compared = 0;
  double force_rms_N = 0;
  double force_max_N = 0;

  std::size_t count(FrameStatus status) const {
    return by_status[static_cast<std::size_t>(status)];
  }
};

/// Estimates all frames given by their gauge volts. Frames are independent and
/// each starts cold, so the results do not depend on `threads`.
std::vector<FrameEstimate> EstimateFrames(
    const Finger& finger, const Scene& scene,
    const Discretization& discretization,
    const std::vector<std::vector<double>>& readings_V, int threads);

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
