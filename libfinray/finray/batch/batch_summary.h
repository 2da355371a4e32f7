#ifndef FINRAY_BATCH_BATCH_SUMMARY_H_
#define FINRAY_BATCH_BATCH_SUMMARY_H_

#include <string>
#include <vector>

#include "finray/batch/log_job.h"
#include "finray/io/frame_table.h"

namespace finray {

/// A log that is left out, as it is bad input.
struct BadLog {
  std::string log, reason;
};

/// Of all frames of all logs.
EstimationSummary Total(const std::vector<LogJob>& jobs);

/// summary.yaml: what was in force, each log, all of them and bad ones, if any.
std::string BatchYaml(const BatchSettings& settings,
                      const std::vector<LogJob>& jobs,
                      const std::vector<BadLog>& bad_logs);

/// summary.csv: a row for each log.
FrameTable BatchTable(const std::vector<LogJob>& jobs);

}  // namespace finray

#endif  // FINRAY_BATCH_BATCH_SUMMARY_H_
