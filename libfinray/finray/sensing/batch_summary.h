#ifndef FINRAY_SENSING_BATCH_SUMMARY_H_
#define FINRAY_SENSING_BATCH_SUMMARY_H_

#include <string>
#include <vector>

#include "finray/io/frame_table.h"
#include "finray/sensing/log_job.h"

namespace finray {

/// Of all frames of all logs.
EstimationSummary Total(const std::vector<LogJob>& jobs);

/// summary.yaml: what was in force, each log and all of them.
std::string BatchYaml(const BatchSettings& settings,
                      const std::vector<LogJob>& jobs);

/// summary.csv: a row for each log.
FrameTable BatchTable(const std::vector<LogJob>& jobs);

}  // namespace finray

#endif  // FINRAY_SENSING_BATCH_SUMMARY_H_
