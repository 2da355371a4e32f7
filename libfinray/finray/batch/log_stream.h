#ifndef FINRAY_BATCH_LOG_STREAM_H_
#define FINRAY_BATCH_LOG_STREAM_H_

#include <cstddef>
#include <functional>
#include <string>

#include "finray/batch/estimation_summary.h"
#include "finray/batch/frame_solver.h"
#include "finray/io/frame_reader.h"

namespace finray {

/// What a block of kBlockFrames frames came to.
struct StreamedBlock {
  std::string csv;  ///< Its rows; the header is before those of the first.
  EstimationSummary summary;
};

// Both functions go through a log from where the reader is (the begin of a
// block) to its end. Few blocks are under way at a time, so that memory does
// not grow with the log; lines are read one after the other, all else is done
// on `threads` threads. `stop` (may be empty) is asked before each block is
// read; false is returned if it made an end.

/// Estimates; `write` gets all blocks that were read one by one in their order.
/// Throws InputError for a bad log, and what `write` throws.
bool EstimateStream(const Finger& finger, const Scene& scene,
                    FrameSolverPool* pool, int threads,
                    const std::function<bool()>& stop, FrameReader* reader,
                    const std::function<void(const StreamedBlock&)>& write);

/// Reads and parses only. Throws InputError at the first bad place of the log.
bool CheckStream(const Finger& finger, int threads,
                 const std::function<bool()>& stop, FrameReader* reader);

}  // namespace finray

#endif  // FINRAY_BATCH_LOG_STREAM_H_
