#include "finray/sensing/frame_results.h"

#include "finray/sensing/reading_columns.h"
#include "finray/sensing/result_columns.h"

namespace finray {

std::vector<FrameReadings> ReadReadings(const Finger& finger,
                                        const FrameTable& log) {
  const std::vector<std::string> names = log.headers();
  const ReadingColumns columns(finger, names, log.path());
  std::vector<FrameReadings> readings(log.rows());
  for (std::size_t row = 0; row < log.rows(); ++row) {
    columns.Read([&](std::size_t i) { return log.Numbers(names[i])[row]; },
                 &readings[row]);
  }
  return readings;
}

void FillResults(const Finger& finger, const Scene& scene,
                 const std::vector<FrameReadings>& readings,
                 const std::vector<FrameEstimate>& estimates, FrameTable* log) {
  const ResultColumns columns(finger, scene);
  std::vector<std::vector<double>*> filled;
  for (const std::string& name : columns.names()) {
    filled.push_back(&log->MutableNumbers(name));
  }
  std::vector<std::string>& status = log->MutableText("status");
  std::vector<double> values(filled.size());
  for (std::size_t row = 0; row < estimates.size(); ++row) {
    columns.Values(readings[row], estimates[row], values.data());
    for (std::size_t i = 0; i < filled.size(); ++i) {
      (*filled[i])[row] = values[i];
    }
    status[row] = StatusName(estimates[row].status);
  }
}

}  // namespace finray
