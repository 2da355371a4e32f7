#ifndef FINRAY_BATCH_LOG_STREAM_H_
#define FINRAY_BATCH_LOG_STREAM_H_

#include <cstddef>
#include <functional>
#include <string>

#include "finray/batch/batch_estimation.h"
#include "finray/batch/estimation_summary.h"
#include "finray/io/frame_reader.h"

namespace finray {

/// The result of a block of kBlockFrames frames.
struct StreamedBlock {
  std::string csv;  ///< Its rows; the first block begins with the header.
  EstimationSummary summary;
};

// These functions process a log from the reader's position (the start of a
// block) to its end, on `threads` threads. Memory does not grow with the log.
// `stop` (may be empty) is asked before each block is read. If it returns true,
// the function ends and returns false. `write` receives blocks one by one and
// in order. The functions throw InputError for a bad log, and what `write`
// throws.

/// Estimates the frames of a log one by one. Only a few blocks are in memory at
/// a time. `write` receives all blocks that were read, also after `stop`. The
/// first `done` rows, whole blocks, are estimated already: the function only
/// skips them, or reads what they say of the creep of gauges.
bool EstimateStream(const Finger& finger, const Scene& scene,
                    FrameSolverPool* pool, int threads,
                    const std::function<bool()>& stop, FrameReader* reader,
                    const std::function<void(const StreamedBlock&)>& write,
                    std::size_t done = 0);

/// Solves the frames of a log together (LogEstimator). The reader must be at
/// the begin of the log. Rows wait in memory until their window is solved, at
/// most LogEstimator::kLongestWindow frames and the blocks about them. Rows
/// that wait when `stop` says so are lost.
bool EstimateJointly(const Finger& finger, const Scene& scene,
                     const Discretization& discretization, int threads,
                     const std::function<bool()>& stop, FrameReader* reader,
                     const std::function<void(const StreamedBlock&)>& write);

/// Only reads and parses a log. Throws InputError at the first bad place.
bool CheckStream(const Finger& finger, int threads,
                 const std::function<bool()>& stop, FrameReader* reader);

}  // namespace finray

#endif  // FINRAY_BATCH_LOG_STREAM_H_
