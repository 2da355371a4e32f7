#ifndef FINRAY_SENSING_FRAME_RESULTS_H_
#define FINRAY_SENSING_FRAME_RESULTS_H_

#include <vector>

#include "finray/io/frame_table.h"
#include "finray/sensing/frame_estimator.h"

namespace finray {

/// What each row has measured: volts of all gauges from gauge_<j>_V or, where
/// that is all there is, gauge_<j>_rad. Throws InputError if a gauge of the
/// finger has no column.
std::vector<FrameReadings> ReadReadings(const Finger& finger,
                                        const FrameTable& log);

/// Fills in contact_1_*, normal_1_*, friction_1, gauge angles, ribs, tip, chi2,
/// iterations and status of each row. Which columns that adds depends on those
/// of the table, the finger and the scene only.
void FillResults(const Finger& finger, const Scene& scene,
                 const std::vector<FrameReadings>& readings,
                 const std::vector<FrameEstimate>& estimates, FrameTable* log);

}  // namespace finray

#endif  // FINRAY_SENSING_FRAME_RESULTS_H_
