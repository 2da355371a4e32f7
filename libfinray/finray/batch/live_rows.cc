#include "finray/batch/live_rows.h"

#include <cmath>

#include "finray/io/error.h"

namespace finray {

LiveRows::LiveRows(const Finger& finger, const Scene& scene,
                   const std::string& source, const CsvLine& header,
                   LiveEstimator* estimator)
    : parser_(source, header, scene.columns),
      layout_(finger, scene, parser_),
      estimator_(*estimator) {
  estimator_.Restart();
}

const std::string& LiveRows::Next(const CsvLine& line) {
  rows_.Clear();
  row_.clear();
  error_.clear();
  try {
    parser_.Parse(line, &rows_);
    layout_.Read(rows_, 0, &readings_);
  } catch (const InputError& error) {
    error_ = error.what();
    layout_.Read(rows_, 0, &readings_);
    for (double& volts : readings_.gauges_V) volts = std::nan("");
  }
  const FrameEstimate& estimate = estimator_.Next(readings_);
  status_ = estimate.status;
  writer_.Append(layout_, rows_, 0, readings_, estimate, &row_);
  return row_;
}

}  // namespace finray
