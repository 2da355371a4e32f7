#ifndef FINRAY_APPS_FOLLOW_INPUT_H_
#define FINRAY_APPS_FOLLOW_INPUT_H_

#include <cstdio>
#include <functional>
#include <optional>

#include "finray/batch/estimation_summary.h"
#include "finray/batch/log_job.h"
#include "finray/view/live_server.h"

namespace finray {

/// What `finray_estimate --follow` does beside estimating.
struct FollowSettings {
  bool strict = false;  ///< A line that cannot be read is an error.
  std::optional<ServeSettings> serve;
  double updates_Hz = 20;  ///< Of live pages.
  /// Can be read as soon as the user asks to stop.
  int stop_file = -1;
  std::function<bool()> stop;
};

/// Reads a log from standard input and writes each row to standard output at
/// once. It ends with its input, with a stop, or when nobody reads its output
/// any more. Then it says how long the rows have taken, from having the whole
/// line to having written its row. Returns their summary; nothing if it was
/// stopped before there was a header.
std::optional<EstimationSummary> FollowInput(const BatchSettings& settings,
                                             const FollowSettings& follow);

/// Says how many searches the scene's limit has ended, if it has one.
void PrintEnded(const EstimationSummary& summary, const Scene& scene,
                std::FILE* out);

}  // namespace finray

#endif  // FINRAY_APPS_FOLLOW_INPUT_H_
