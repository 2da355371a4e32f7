#ifndef FINRAY_BATCH_LOG_JOB_H_
#define FINRAY_BATCH_LOG_JOB_H_

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "finray/batch/batch_estimation.h"
#include "finray/batch/estimation_warnings.h"
#include "finray/batch/log_stream.h"
#include "finray/estimation/hidden_forces.h"
#include "finray/io/frame_table.h"
#include "finray/io/resumable_file.h"

namespace finray {

/// The settings that all logs of a batch share.
struct BatchSettings {
  BatchSettings(const std::string& finger_path, const std::string& scene_path,
                const Discretization& discretization);

  Finger finger;
  Scene scene;
  Discretization discretization;
  FrameMethod method = FrameMethod::kFast;
  /// Solves all frames of a log together (EstimateJointly) instead of one by
  /// one. An interrupted log then begins anew.
  bool joint = false;
  /// What is written of the results, and whether bad rows are left out.
  ResultFormat format;
  bool skip_bad_rows = false;
  /// "" without a scene file. That of a scene covers the mapping it names.
  std::string finger_sha256, scene_sha256;
  int threads = 1;
  /// Continues what an earlier run has left unfinished, and keeps what it has
  /// finished.
  bool resume = false;
  /// Number of blocks of kBlockFrames between two checkpoints. A crash loses at
  /// most this many.
  std::size_t chunk_blocks = 64;
  /// Polled now and then. If it returns true, the job saves everything and
  /// ends. May be empty.
  std::function<bool()> stop;
  /// Called with the number of frames written since the last call, and whether
  /// they are kept from an earlier run. May be empty.
  std::function<void(std::size_t frames, bool kept)> progress;
};

/// Estimates one log into its result, D/<log>.frames.csv, with a summary beside
/// it, D/<log>.summary.yaml, and D/<log>.bad_rows.csv if rows were left out.
/// The summary holds a key: a SHA-256 over the contents of the log, the finger
/// and the scene file, and over scheme, resolution, solver, version,
/// kBlockFrames, what is written and the number of the results' format. Results
/// with the same key have the same bytes.
///
/// All functions throw InputError for a bad log or a result that cannot be
/// written.
class LogJob {
 public:
  LogJob(const BatchSettings* settings, std::string log, std::string result);

  /// Finds the key, and whether an earlier run has finished this log. If not,
  /// reads the log to its end, so that a bad cell is found before any work is
  /// done. Returns false if told to stop.
  bool Check();
  /// Estimates what is left to do, and writes result and summary. The folder
  /// must exist. Returns false if told to stop; the job can then be resumed.
  /// `pool` solves the frames one by one; it is not used with `joint`.
  bool Run(FrameSolverPool* pool);

  /// Renames the result of an earlier run to <result>.old and removes what
  /// belongs to it, since it is not that of the log. Returns false if there is
  /// none.
  bool SetAside() const;

  const std::string& log() const { return log_; }
  const std::string& result() const { return result_; }
  const std::string& key() const { return key_; }
  /// Number of frames of the log, known after Check().
  std::size_t frames() const { return frames_; }
  /// Summary of all frames written so far, by this run or an earlier one.
  const EstimationSummary& summary() const { return summary_; }
  /// Why the finger does not fit the log, if a warning says that it does not,
  /// or what is wrong with its gauges.
  const LogCause& cause() const { return cause_; }
  /// The damaged file of an interrupted run of which Run() could not keep all
  /// checkpoints, or "".
  const std::string& damaged() const { return damaged_; }

 private:
  bool ReadFinished();
  // Fills the result file and gives it its final name. Returns false if told to
  // stop.
  bool Estimate(FrameSolverPool* pool, ResumableFile* out);
  void FindCause();
  void ReportProgress(std::size_t frames, bool kept) const;
  StreamOptions Options() const;
  // Writes the table of bad rows, or removes an older one.
  void WriteBadRows() const;
  void WriteSummary(std::uint64_t bytes) const;
  // Says whether the log has changed since it was checked.
  bool Changed() const;

  const BatchSettings* settings_;
  std::string log_, result_, summary_path_, bad_rows_path_, log_sha256_, key_,
      damaged_;
  std::vector<BadRow> bad_rows_;
  std::filesystem::file_time_type written_;
  std::uintmax_t bytes_ = 0;
  std::size_t frames_ = 0;
  bool finished_before_ = false, faulty_ = false;
  EstimationSummary summary_;
  LogCause cause_;
};

/// A log that is left out because it is bad input.
struct BadLog {
  std::string log, reason;
};

/// The summary of all frames of all logs.
EstimationSummary Total(const std::vector<LogJob>& jobs);

/// Names and summaries of all logs, for WarningsOf.
std::vector<LogSummary> SummariesOf(const std::vector<LogJob>& jobs);

/// Finds the hidden forces (FindHiddenForces) that summary.yaml reports.
/// Returns nothing with --joint and without contacts.
std::optional<HiddenForces> HiddenForcesOf(const BatchSettings& settings);

/// The text of summary.yaml: the settings, the hidden forces, each log, the
/// total, and bad logs if there are any.
std::string BatchYaml(const BatchSettings& settings,
                      const std::vector<LogJob>& jobs,
                      const std::vector<BadLog>& bad_logs,
                      const std::optional<HiddenForces>& hidden);

/// The table of summary.csv, with a row for each log, and behind these one for
/// each bad log with the reason.
FrameTable BatchTable(const BatchSettings& settings,
                      const std::vector<LogJob>& jobs,
                      const std::vector<BadLog>& bad_logs);

}  // namespace finray

#endif  // FINRAY_BATCH_LOG_JOB_H_
