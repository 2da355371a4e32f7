#ifndef FINRAY_BATCH_JOINT_STREAM_H_
#define FINRAY_BATCH_JOINT_STREAM_H_

#include "finray/batch/log_stream.h"

namespace finray {

/// Estimates a log like EstimateStream, but solves its frames together
/// (LogEstimator). The reader must be at the begin of the log. Rows wait in
/// memory until their window is solved. Windows do not grow with the log.
bool EstimateJointly(const Finger& finger, const Scene& scene,
                     const Discretization& discretization, int threads,
                     const std::function<bool()>& stop, FrameReader* reader,
                     const std::function<void(const StreamedBlock&)>& write);

}  // namespace finray

#endif  // FINRAY_BATCH_JOINT_STREAM_H_
