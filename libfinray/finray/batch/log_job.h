#ifndef FINRAY_BATCH_LOG_JOB_H_
#define FINRAY_BATCH_LOG_JOB_H_

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

#include "finray/batch/estimation_summary.h"
#include "finray/batch/frame_solver.h"
#include "finray/io/resumable_file.h"

namespace finray {

/// What the logs of a batch have in common.
struct BatchSettings {
  BatchSettings(const std::string& finger_path, const std::string& scene_path,
                const Discretization& discretization);

  Finger finger;
  Scene scene;
  Discretization discretization;
  FrameMethod method = FrameMethod::kFast;
  std::string finger_sha256, scene_sha256;  ///< "" without a scene file.
  int threads = 1;
  /// Go on with what an earlier run has left, and keep what it has finished.
  bool resume = false;
  /// Blocks of kBlockFrames from one checkpoint to the next: what a crash can
  /// lose at most.
  std::size_t chunk_blocks = 64;
  /// Asked now and then; true makes an end with everything saved. May be empty.
  std::function<bool()> stop;
  /// Told the number of frames that have been written since it was told last,
  /// and whether they are kept from an earlier run. May be empty.
  std::function<void(std::size_t frames, bool kept)> progress;
};

/// Estimates one log into its result, D/<log>.frames.csv, with its own summary
/// beside it, D/<log>.summary.yaml. Results carry a key there: a SHA-256 over
/// the contents of the log, the finger and the scene file, over scheme,
/// resolution, version, kBlockFrames and the number of the results' format.
/// Whatever has the same key has the same bytes.
///
/// All functions throw InputError, for a bad log or a result that cannot be
/// written.
class LogJob {
 public:
  LogJob(const BatchSettings* settings, std::string log, std::string result);

  /// Finds the key and whether an earlier run has finished this log; if not,
  /// reads it to its end, so that a bad cell is found before any work is done.
  /// Returns false if it was told to stop.
  bool Check();
  /// Estimates what is left to do, and writes result and summary. The folder
  /// must be there. Returns false if it was told to stop, all being ready to be
  /// resumed.
  bool Run(FrameSolverPool* pool);

  const std::string& log() const { return log_; }
  const std::string& result() const { return result_; }
  const std::string& key() const { return key_; }
  /// Frames of the log, as soon as it has been checked.
  std::size_t frames() const { return frames_; }
  /// Of all frames written so far, by this run or an earlier one.
  const EstimationSummary& summary() const { return summary_; }

 private:
  bool ReadFinished();
  // Fills the result and gives it its name; false if told to stop.
  bool Estimate(FrameSolverPool* pool, ResumableFile* out);
  void ReportProgress(std::size_t frames, bool kept) const;
  void WriteSummary(std::uint64_t bytes) const;
  // Whether the log is no longer the one that was checked.
  bool Changed() const;

  const BatchSettings* settings_;
  std::string log_, result_, summary_path_, log_sha256_, key_;
  std::filesystem::file_time_type written_;
  std::uintmax_t bytes_ = 0;
  std::size_t frames_ = 0;
  bool finished_before_ = false;
  EstimationSummary summary_;
};

}  // namespace finray

#endif  // FINRAY_BATCH_LOG_JOB_H_
