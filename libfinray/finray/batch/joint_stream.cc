#include "finray/batch/joint_stream.h"

#include <deque>
#include <string>
#include <vector>

#include "finray/batch/result_rows.h"
#include "finray/io/error.h"
#include "finray/sensing/log_estimator.h"

namespace finray {
namespace {

// Rows that wait for their estimates.
struct Waiting {
  LineBlock lines;
  FrameRows rows;
  std::vector<Measurements> readings;
  std::vector<FrameEstimate> estimates;
};

StreamedBlock Written(const ResultLayout& layout, double friction,
                      const Waiting& block, bool first) {
  StreamedBlock result;
  ResultWriter writer;
  if (first) result.csv = layout.HeaderCsv();
  for (std::size_t row = 0; row < block.estimates.size(); ++row) {
    const FrameEstimate& estimate = block.estimates[row];
    writer.Append(layout, block.rows, row, block.readings[row], estimate,
                  &result.csv);
    result.summary.Add(estimate, friction, block.readings[row].force_N);
  }
  return result;
}

}  // namespace

bool EstimateJointly(const Finger& finger, const Scene& scene,
                     const Discretization& discretization, int threads,
                     const std::function<bool()>& stop, FrameReader* reader,
                     const std::function<void(const StreamedBlock&)>& write) {
  const FrameParser& parser = reader->parser();
  const ResultLayout layout(finger, scene, parser);
  std::deque<Waiting> waiting;
  bool first = true;
  LogEstimator estimator(
      finger, scene, discretization, threads,
      [&](const FrameEstimate& estimate) {
        Waiting& block = waiting.front();
        block.estimates.push_back(estimate);
        if (block.estimates.size() < block.readings.size()) return;
        write(Written(layout, scene.friction_coefficient, block, first));
        first = false;
        waiting.pop_front();
      });
  std::size_t row_of_log = 0;
  while (true) {
    if (stop && stop()) return false;
    Waiting& block = waiting.emplace_back();
    if (!reader->ReadLines(kBlockFrames, &block.lines)) {
      waiting.pop_back();
      break;
    }
    if (!block.lines.error.empty()) throw InputError(block.lines.error);
    for (std::size_t i = 0; i < block.lines.size(); ++i) {
      parser.Parse(block.lines.at(i), &block.rows);
    }
    block.readings.resize(block.rows.rows());
    for (std::size_t row = 0; row < block.readings.size(); ++row) {
      layout.Read(block.rows, row, &block.readings[row]);
    }
    // The estimator may give back frames of this block while it takes them.
    const std::vector<Measurements> readings = block.readings;
    for (const Measurements& row : readings) {
      ++row_of_log;
      try {
        estimator.Add(row);
      } catch (const InputError& error) {
        throw InputError(parser.path() + ": row " + std::to_string(row_of_log) +
                         ": " + error.what());
      }
    }
  }
  estimator.Finish();
  return true;
}

}  // namespace finray
