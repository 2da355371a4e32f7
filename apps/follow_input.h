#ifndef FINRAY_APPS_FOLLOW_INPUT_H_
#define FINRAY_APPS_FOLLOW_INPUT_H_

#include <cstdio>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "finray/batch/estimation_summary.h"
#include "finray/batch/live_rows.h"
#include "finray/batch/log_job.h"
#include "finray/io/line_reader.h"
#include "finray/view/live_server.h"

namespace finray {

/// Where the rows of `finray_estimate --follow` come from and go to, and what
/// it does beside estimating.
struct FollowSettings {
  std::string source = "stdin";  ///< The name of the input in messages.
  /// Without it standard input is read.
  ByteSource read;
  /// Takes a row with its line end. Returns false if nobody reads rows any
  /// more. Without it they go to standard output.
  std::function<bool(std::string_view)> write;
  /// An estimator of the settings whose tables are used, for several inputs at
  /// a time; nothing else may use it.
  const FrameEstimator* prepared = nullptr;
  bool strict = false;  ///< A line that cannot be read is an error.
  /// Warn of a finger that is not calibrated, as soon as there is a header.
  bool warn_of_finger = true;
  std::optional<ServeSettings> serve;
  double updates_Hz = 20;  ///< Of live pages.
  /// Can be read as soon as the user asks to stop.
  int stop_file = -1;
  std::function<bool()> stop;
};

/// The result of an input that was followed to its end.
struct Followed {
  EstimationSummary summary;
  /// From having a whole line to having written its row.
  LatencyHistogram latency;
};

/// Reads a log from the input and writes each row to the output at once. It
/// ends with its input, with a stop, or when nobody reads its output any more.
/// Returns nothing if it was stopped before there was a header. Throws
/// InputError for a header that does not suffice, and if input or output fail.
std::optional<Followed> FollowInput(const BatchSettings& settings,
                                    const FollowSettings& follow);

/// Prints the quantiles of a latency on stderr, with a label of 14 characters.
void PrintLatency(const char* label, const LatencyHistogram& latency);

/// Says how many searches the scene's limit has ended, if it has one.
void PrintEnded(const char* label, const EstimationSummary& summary,
                const Scene& scene, std::FILE* out);

}  // namespace finray

#endif  // FINRAY_APPS_FOLLOW_INPUT_H_
