#ifndef FINRAY_BATCH_LIVE_ROWS_H_
#define FINRAY_BATCH_LIVE_ROWS_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "finray/batch/result_rows.h"
#include "finray/estimation/frame_estimator.h"
#include "finray/io/frame_parser.h"
#include "finray/scene/history_filter.h"

namespace finray {

/// Turns each line of a log into its row of the result before the next line
/// arrives. The columns are those of a batch.
class LiveRows {
 public:
  /// `parser` is that of the log (LogLines). Throws InputError if its columns
  /// do not suffice. Parser and estimator must stay in place; the latter must
  /// be made for this finger and scene. It is restarted, and serves one log at
  /// a time.
  LiveRows(const Finger& finger, const Scene& scene, const FrameParser& parser,
           FrameEstimator* estimator, const ResultFormat& format = {});

  std::string HeaderCsv() const { return layout_.HeaderCsv(); }

  /// Returns the row of a line with its line end; the result is valid until the
  /// next call. A line that cannot be read has the status bad_input and keeps
  /// the cells before its fault.
  const std::string& Next(const CsvLine& line);
  /// The error of the last line (source:line:column), or "" if it has none.
  const std::string& error() const { return error_; }
  /// The estimate of the last line.
  const FrameEstimate& estimate() const { return estimate_; }
  /// Its measurements; NaN if it has an error.
  const Measurements& readings() const { return readings_; }
  /// The same as they were read, with the creep and hysteresis of the gauges.
  const Measurements& raw() const {
    return history_.empty() ? readings_ : raw_;
  }

 private:
  const FrameParser& parser_;
  ResultLayout layout_;
  FrameEstimator& estimator_;
  HistoryFilter history_;
  const bool offsets_wander_;
  FrameRows rows_;
  Measurements readings_, raw_;
  std::vector<double> values_;  // memory, reused by the next row
  std::string row_, error_;
  FrameEstimate estimate_;
};

/// Quantiles of any number of times in fixed memory. Each power of two of
/// nanoseconds has 64 buckets, so a quantile is off by at most 0.8 %.
class LatencyHistogram {
 public:
  void Add(std::uint64_t nanoseconds);

  std::uint64_t count() const { return count_; }
  /// Returns the time in ns that a share (0 to 1) of all times does not exceed:
  /// the middle of its bucket, or 0 if there are none.
  double Quantile(double share) const;
  /// The largest time in ns; exact.
  std::uint64_t max() const { return max_; }

 private:
  static constexpr int kBits = 6;  // 2^kBits buckets in a power of two
  static constexpr std::size_t kBuckets = (64 - kBits + 1) << kBits;

  std::array<std::uint64_t, kBuckets> buckets_{};
  std::uint64_t count_ = 0, max_ = 0;
};

}  // namespace finray

#endif  // FINRAY_BATCH_LIVE_ROWS_H_
