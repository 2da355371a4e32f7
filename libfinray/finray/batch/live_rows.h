#ifndef FINRAY_BATCH_LIVE_ROWS_H_
#define FINRAY_BATCH_LIVE_ROWS_H_

#include <string>

#include "finray/batch/result_rows.h"
#include "finray/io/frame_parser.h"
#include "finray/sensing/live_estimator.h"

namespace finray {

/// Lines of a log as they come, each turned into its row of the result before
/// the next one is there. Columns are those of a batch.
class LiveRows {
 public:
  /// `header` is the line of a log from `source`, which messages name. Throws
  /// InputError for a bad one. The estimator, of this finger and scene, must
  /// stay in place; it is restarted, and serves one log at a time.
  LiveRows(const Finger& finger, const Scene& scene, const std::string& source,
           const CsvLine& header, LiveEstimator* estimator);

  std::string HeaderCsv() const { return layout_.HeaderCsv(); }

  /// The row of a line, with its line end; it lives until the next call. A line
  /// that cannot be read has the status bad_input and keeps the cells before
  /// its fault.
  const std::string& Next(const CsvLine& line);
  /// What was wrong with it (source:line:column), or "".
  const std::string& error() const { return error_; }
  FrameStatus status() const { return status_; }

 private:
  FrameParser parser_;
  ResultLayout layout_;
  LiveEstimator& estimator_;
  FrameRows rows_;
  Measurements readings_;
  ResultWriter writer_;
  std::string row_, error_;
  FrameStatus status_ = FrameStatus::kBadInput;
};

}  // namespace finray

#endif  // FINRAY_BATCH_LIVE_ROWS_H_
