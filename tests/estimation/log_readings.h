#ifndef FINRAY_TESTS_ESTIMATION_LOG_READINGS_H_
#define FINRAY_TESTS_ESTIMATION_LOG_READINGS_H_

#include <string>
#include <vector>

#include "finray/io/frame_table.h"
#include "finray/scene/measurement_columns.h"

namespace finray {

/// Reads the measurements of each row of a table.
inline std::vector<Measurements> ReadReadings(const Finger& finger,
                                              const FrameTable& log) {
  const std::vector<std::string> names = log.headers();
  const MeasurementColumns columns(finger, names, log.path(), {});
  std::vector<Measurements> readings(log.rows());
  for (std::size_t row = 0; row < log.rows(); ++row) {
    columns.Read([&](std::size_t i) { return log.Numbers(names[i])[row]; },
                 &readings[row]);
  }
  return readings;
}

}  // namespace finray

#endif  // FINRAY_TESTS_ESTIMATION_LOG_READINGS_H_
