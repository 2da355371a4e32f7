#ifndef FINRAY_BATCH_LOG_STREAM_H_
#define FINRAY_BATCH_LOG_STREAM_H_

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "finray/batch/batch_estimation.h"
#include "finray/batch/estimation_summary.h"
#include "finray/batch/result_rows.h"
#include "finray/io/frame_reader.h"

namespace finray {

/// The result of a block of kBlockFrames frames.
struct StreamedBlock {
  std::string csv;  ///< Its rows; the first block begins with the header.
  EstimationSummary summary;
};

struct StreamOptions {
  int threads = 1;
  /// Asked before each block is read. May be empty. If it returns true, the
  /// function ends and returns false.
  std::function<bool()> stop;
  ResultFormat format;
  /// Leaves out rows that are bad instead of throwing InputError.
  bool skip_bad_rows = false;
};

// These functions process a log from the reader's position (the start of a
// block) to its end. Memory does not grow with the log. `write` receives blocks
// one by one and in order. The functions throw InputError for a bad log, and
// what `write` throws.

/// Estimates the frames of a log one by one. Only a few blocks are in memory at
/// a time. `write` receives all blocks that were read, also after `stop`. The
/// first `done` rows, bad ones too, whole blocks, are estimated already: the
/// function only skips them, or reads what they say of the creep of gauges.
bool EstimateStream(const Finger& finger, const Scene& scene,
                    FrameSolverPool* pool, const StreamOptions& options,
                    FrameReader* reader,
                    const std::function<void(const StreamedBlock&)>& write,
                    std::size_t done = 0);

/// Reads a log without estimating it, and hands out its good rows one by one.
void ReadStream(const Finger& finger, const Scene& scene,
                const StreamOptions& options, FrameReader* reader,
                const std::function<void(const Measurements&)>& take);

/// Solves the frames of a log together (LogEstimator). The reader must be at
/// the begin of the log. Rows wait in memory until their window is solved, at
/// most LogEstimator::kLongestWindow frames and the blocks about them. Rows
/// that wait when `stop` says so are lost.
bool EstimateJointly(const Finger& finger, const Scene& scene,
                     const Discretization& discretization,
                     const StreamOptions& options, FrameReader* reader,
                     const std::function<void(const StreamedBlock&)>& write);

/// A row that is left out.
struct BadRow {
  int line;
  std::string reason;  ///< "path:line:column: ..."
};

/// Only reads and parses a log. Throws InputError at the first bad place. With
/// skip_bad_rows, it appends bad rows to `bad_rows` and throws only if there
/// are more than 100 000 of them. Hands out good rows one by one and in order.
bool CheckStream(const Finger& finger, const Scene& scene,
                 const StreamOptions& options, FrameReader* reader,
                 std::vector<BadRow>* bad_rows,
                 const std::function<void(const Measurements&)>& take);

}  // namespace finray

#endif  // FINRAY_BATCH_LOG_STREAM_H_
