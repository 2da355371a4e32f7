#ifndef FINRAY_BATCH_BATCH_SUMMARY_H_
#define FINRAY_BATCH_BATCH_SUMMARY_H_

#include <string>
#include <vector>

#include "finray/batch/log_job.h"
#include "finray/io/frame_table.h"

namespace finray {

/// A log that is left out because it is bad input.
struct BadLog {
  std::string log, reason;
};

/// The summary of all frames of all logs.
EstimationSummary Total(const std::vector<LogJob>& jobs);

/// The text of summary.yaml: the settings, each log, the total, and bad logs if
/// there are any.
std::string BatchYaml(const BatchSettings& settings,
                      const std::vector<LogJob>& jobs,
                      const std::vector<BadLog>& bad_logs);

/// The table of summary.csv, with a row for each log.
FrameTable BatchTable(const std::vector<LogJob>& jobs);

}  // namespace finray

#endif  // FINRAY_BATCH_BATCH_SUMMARY_H_
