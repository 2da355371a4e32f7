#ifndef FINRAY_SENSING_LOG_STREAM_H_
#define FINRAY_SENSING_LOG_STREAM_H_

#include <functional>
#include <string>

#include "finray/io/frame_reader.h"
#include "finray/sensing/estimation_summary.h"
#include "finray/sensing/frame_solver.h"

namespace finray {

/// What a block of kBlockFrames frames came to.
struct StreamedBlock {
  std::string csv;  ///< Its rows; the header is before those of the first.
  EstimationSummary summary;
};

/// Estimates a log from where the reader is (the begin of a block) to its end.
/// A few blocks are under way at a time, on `threads` threads; `write` gets
/// them one by one in their order. Memory does not grow with the log.
///
/// `stop` (may be empty) is asked before each block is read. Returns false if
/// it made an end; all blocks that were read have been written then. Throws
/// what the reader, ReadReadings and `write` throw.
bool EstimateStream(const Finger& finger, const Scene& scene,
                    FrameSolverPool* pool, int threads,
                    const std::function<bool()>& stop, FrameReader* reader,
                    const std::function<void(const StreamedBlock&)>& write);

}  // namespace finray

#endif  // FINRAY_SENSING_LOG_STREAM_H_
