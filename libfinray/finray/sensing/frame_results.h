#ifndef FINRAY_SENSING_FRAME_RESULTS_H_
#define FINRAY_SENSING_FRAME_RESULTS_H_

#include <vector>

#include "finray/io/frame_table.h"
#include "finray/sensing/frame_estimator.h"

namespace finray {

/// What each row has measured (ReadingColumns). Throws InputError if a gauge of
/// the finger has no column.
std::vector<FrameReadings> ReadReadings(const Finger& finger,
                                        const FrameTable& log);

/// Fills in ResultColumns and the status of each row.
void FillResults(const Finger& finger, const Scene& scene,
                 const std::vector<FrameReadings>& readings,
                 const std::vector<FrameEstimate>& estimates, FrameTable* log);

}  // namespace finray

#endif  // FINRAY_SENSING_FRAME_RESULTS_H_
