#ifndef FINRAY_BATCH_JOINT_STREAM_H_
#define FINRAY_BATCH_JOINT_STREAM_H_

#include "finray/batch/log_stream.h"

namespace finray {

/// As EstimateStream, but the frames of the log are solved together
/// (LogEstimator): the reader is at the begin of the log. Rows wait in memory
/// until their window is solved; windows do not grow with the log.
bool EstimateJointly(const Finger& finger, const Scene& scene,
                     const Discretization& discretization, int threads,
                     const std::function<bool()>& stop, FrameReader* reader,
                     const std::function<void(const StreamedBlock&)>& write);

}  // namespace finray

#endif  // FINRAY_BATCH_JOINT_STREAM_H_
