#include "finray/batch/log_stream.h"

#include <tbb/global_control.h>
#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <deque>

#include "finray/batch/result_rows.h"
#include "finray/estimation/log_estimator.h"
#include "finray/io/error.h"
#include "finray/scene/history_filter.h"

namespace finray {
namespace {

// Blocks in progress for each thread: enough to keep all threads busy while one
// of them writes to the disk.
constexpr int kBlocksPerThread = 8;
// Number of rows in a block that is only checked.
constexpr std::size_t kCheckedRows = 512;
// A list of more bad rows helps nobody.
constexpr std::size_t kMostBadRows = 100'000;

// The data of a block at all stages. Later blocks reuse its memory.
struct Block {
  LineBlock lines;
  FrameRows rows;
  std::vector<BadRow> bad_rows;
  bool first = false;  // of the log
  std::vector<Measurements> readings;
  std::vector<FrameEstimate> estimates;
  std::vector<double> values;
  StreamedBlock result;
};

// Reads lines into a block. Returns false if none is left.
bool ReadBlock(std::size_t rows, FrameReader* reader, Block* block) {
  block->first = reader->position() == 0;
  return reader->ReadLines(rows, &block->lines);
}

// Parses the lines, up to the first bad one unless these are skipped. An error
// in an earlier line replaces the reader's error, which lies behind these
// lines.
void Parse(const FrameParser& parser, bool skip_bad_rows, Block* block) {
  block->rows.Clear();
  block->bad_rows.clear();
  for (std::size_t i = 0; i < block->lines.size(); ++i) {
    try {
      parser.Parse(block->lines.at(i), &block->rows);
    } catch (const InputError& error) {
      if (!skip_bad_rows) {
        block->lines.error = error.what();
        return;
      }
      block->rows.DropRow();
      block->bad_rows.push_back({block->lines.at(i).number, error.what()});
    }
  }
}

void ReadReadings(const ResultLayout& layout, Block* block) {
  block->readings.resize(block->rows.rows());
  for (std::size_t row = 0; row < block->readings.size(); ++row) {
    layout.Read(block->rows, row, &block->readings[row]);
  }
}

void RemoveHistory(HistoryFilter* history, Block* block) {
  for (Measurements& row : block->readings) history->Remove(&row);
}

// Fills in the result from the estimates.
void WriteResult(const ResultLayout& layout, const Finger& finger,
                 double friction, Block* block) {
  StreamedBlock& result = block->result;
  result.summary = EstimationSummary();
  result.summary.bad_rows = block->bad_rows.size();
  result.csv.clear();
  if (block->first) result.csv = layout.HeaderCsv();
  for (std::size_t row = 0; row < block->readings.size(); ++row) {
    const Measurements& readings = block->readings[row];
    const FrameEstimate& estimate = block->estimates[row];
    layout.Append(block->rows, row, readings, estimate, &block->values,
                  &result.csv);
    result.summary.Add(estimate, friction, readings, finger);
  }
}

// Says that all blocks of a log are independent of each other.
const std::function<void(Block*)> kIndependent;

// Runs `work` on blocks of `rows` lines in parallel, and `finish` on one block
// at a time in order. Before the work, `prepare` sees the blocks one at a time
// in order, if they depend on each other. Throws InputError at the first bad
// block. Returns false if told to stop.
bool ForEachBlock(const StreamOptions& options, std::size_t rows,
                  FrameReader* reader,
                  const std::function<void(Block*)>& prepare,
                  const std::function<void(Block*)>& work,
                  const std::function<void(const Block&)>& finish) {
  const int threads = std::max(1, options.threads);
  // The pipeline holds at most ring.size() blocks, so a block is finished
  // before its place in the ring is used again.
  std::vector<Block> ring(static_cast<std::size_t>(threads * kBlocksPerThread));
  std::size_t next = 0;
  bool stopped = false;
  const auto read = [&](tbb::flow_control& flow) -> Block* {
    Block* block = &ring[next++ % ring.size()];
    stopped = options.stop && options.stop();
    if (stopped || !ReadBlock(rows, reader, block)) flow.stop();
    return block;
  };
  const auto parse = [&](Block* block) {
    Parse(reader->parser(), options.skip_bad_rows, block);
    return block;
  };
  const auto prepare_one = [&](Block* block) {
    if (block->lines.error.empty()) prepare(block);
    return block;
  };
  const auto work_on = [&](Block* block) {
    if (block->lines.error.empty()) work(block);
    return block;
  };
  const auto hand_over = [&](Block* block) {
    if (!block->lines.error.empty()) throw InputError(block->lines.error);
    finish(*block);
  };
  using tbb::filter_mode;
  auto parsed = tbb::make_filter<Block*, Block*>(filter_mode::parallel, parse);
  if (prepare) {
    parsed = parsed & tbb::make_filter<Block*, Block*>(
                          filter_mode::serial_in_order, prepare_one);
  }
  // Uses as many threads as asked for, even if the machine has fewer cores.
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                  static_cast<std::size_t>(threads));
  tbb::task_arena(threads).execute([&] {
    tbb::parallel_pipeline(
        ring.size(),
        tbb::make_filter<void, Block*>(filter_mode::serial_in_order, read) &
            parsed &
            tbb::make_filter<Block*, Block*>(filter_mode::parallel, work_on) &
            tbb::make_filter<Block*, void>(filter_mode::serial_in_order,
                                           hand_over));
  });
  return !stopped;
}

}  // namespace

bool EstimateStream(const Finger& finger, const Scene& scene,
                    FrameSolverPool* pool, const StreamOptions& options,
                    FrameReader* reader,
                    const std::function<void(const StreamedBlock&)>& write,
                    std::size_t done) {
  const ResultLayout layout(finger, scene, reader->parser(), options.format);
  HistoryFilter history(finger, scene);
  if (history.empty()) reader->Skip(done);
  Block skipped;
  while (reader->position() < done &&
         ReadBlock(kBlockFrames, reader, &skipped)) {
    Parse(reader->parser(), options.skip_bad_rows, &skipped);
    ReadReadings(layout, &skipped);
    RemoveHistory(&history, &skipped);
  }
  // Creep and hysteresis depend on all rows before.
  const auto read_in_order = [&](Block* block) {
    ReadReadings(layout, block);
    RemoveHistory(&history, block);
  };
  return ForEachBlock(
      options, kBlockFrames, reader,
      history.empty() ? kIndependent : read_in_order,
      [&](Block* block) {
        if (history.empty()) ReadReadings(layout, block);
        block->estimates.resize(block->readings.size());
        pool->SolveBlock(block->readings.data(), block->readings.size(),
                         block->estimates.data());
        WriteResult(layout, finger, scene.friction_coefficient, block);
      },
      [&](const Block& block) { write(block.result); });
}

void ReadStream(const Finger& finger, const Scene& scene,
                const StreamOptions& options, FrameReader* reader,
                const std::function<void(const Measurements&)>& take) {
  const ResultLayout layout(finger, scene, reader->parser(), options.format);
  Block block;
  while (ReadBlock(kCheckedRows, reader, &block)) {
    Parse(reader->parser(), options.skip_bad_rows, &block);
    if (!block.lines.error.empty()) throw InputError(block.lines.error);
    ReadReadings(layout, &block);
    for (const Measurements& row : block.readings) take(row);
  }
}

bool EstimateJointly(const Finger& finger, const Scene& scene,
                     const Discretization& discretization,
                     const StreamOptions& options, FrameReader* reader,
                     const std::function<void(const StreamedBlock&)>& write) {
  const FrameParser& parser = reader->parser();
  const ResultLayout layout(finger, scene, parser, options.format);
  HistoryFilter history(finger);
  std::deque<Block> waiting;  // for their estimates
  LogEstimator estimator(finger, scene, discretization, options.threads,
                         [&](const FrameEstimate& estimate) {
                           Block& block = waiting.front();
                           block.estimates.push_back(estimate);
                           if (block.estimates.size() < block.readings.size())
                             return;
                           WriteResult(layout, finger,
                                       scene.friction_coefficient, &block);
                           write(block.result);
                           waiting.pop_front();
                         });
  std::size_t row_of_log = 0;
  // Bad rows at the end of what was read; the next good row brings them along.
  std::vector<BadRow> bad_rows;
  while (!options.stop || !options.stop()) {
    Block& block = waiting.emplace_back();
    if (!ReadBlock(kBlockFrames, reader, &block)) {
      estimator.Finish();
      StreamedBlock rest;
      rest.summary.bad_rows = bad_rows.size();
      rest.summary.walk = estimator.walk();
      rest.summary.alone = estimator.alone();
      write(rest);
      return true;
    }
    Parse(parser, options.skip_bad_rows, &block);
    if (!block.lines.error.empty()) throw InputError(block.lines.error);
    block.first = row_of_log == 0;
    block.bad_rows.insert(block.bad_rows.end(), bad_rows.begin(),
                          bad_rows.end());
    bad_rows.clear();
    if (block.rows.rows() == 0) {
      bad_rows.swap(block.bad_rows);
      waiting.pop_back();
      continue;
    }
    ReadReadings(layout, &block);
    RemoveHistory(&history, &block);
    // The estimator may give back all frames with the last one that it takes.
    // Then the block is gone.
    const std::size_t rows = block.readings.size();
    for (std::size_t row = 0; row < rows; ++row) {
      ++row_of_log;
      try {
        estimator.Add(block.readings[row]);
      } catch (const InputError& error) {
        throw InputError(parser.path() + ": row " + std::to_string(row_of_log) +
                         ": " + error.what());
      }
    }
  }
  return false;
}

bool CheckStream(const Finger& finger, const Scene& scene,
                 const StreamOptions& options, FrameReader* reader,
                 std::vector<BadRow>* bad_rows,
                 const std::function<void(const Measurements&)>& take) {
  const FrameParser& parser = reader->parser();
  const ResultLayout layout(finger, scene, parser, options.format);
  RequireTimeForCreep(finger, parser.names(), parser.path());
  return ForEachBlock(
      options, kCheckedRows, reader, kIndependent,
      [&](Block* block) { ReadReadings(layout, block); },
      [&](const Block& block) {
        for (const Measurements& row : block.readings) take(row);
        bad_rows->insert(bad_rows->end(), block.bad_rows.begin(),
                         block.bad_rows.end());
        if (bad_rows->size() > kMostBadRows) {
          throw InputError(
              parser.path() + ": more than " + std::to_string(kMostBadRows) +
              " rows are bad; the first: " + bad_rows->front().reason);
        }
      });
}

}  // namespace finray
