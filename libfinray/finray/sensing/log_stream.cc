#include "finray/sensing/log_stream.h"

#include <tbb/global_control.h>
#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <memory>

#include "finray/sensing/frame_results.h"

namespace finray {
namespace {

// Blocks under way for each thread: enough to keep all busy while one of them
// writes to the disk.
constexpr int kBlocksPerThread = 8;

struct Block {
  bool first = false;  // of the log
  FrameTable frames;
  StreamedBlock result;
};

void Estimate(const Finger& finger, const Scene& scene, FrameSolverPool* pool,
              Block* block) {
  FrameTable& frames = block->frames;
  const std::size_t rows = frames.rows();
  const auto readings = ReadReadings(finger, frames);
  std::vector<FrameEstimate> estimates(rows);
  pool->SolveBlock(readings.data(), rows, estimates.data());
  FillResults(finger, scene, readings, estimates, &frames);
  const std::vector<double> force = frames.NumbersOrNan("force_N");
  for (std::size_t row = 0; row < rows; ++row) {
    block->result.summary.Add(estimates[row], scene.friction_coefficient,
                              force[row]);
  }
  if (block->first) block->result.csv = frames.HeaderCsv();
  block->result.csv += frames.RowsCsv();
}

}  // namespace

bool EstimateStream(const Finger& finger, const Scene& scene,
                    FrameSolverPool* pool, int threads,
                    const std::function<bool()>& stop, FrameReader* reader,
                    const std::function<void(const StreamedBlock&)>& write) {
  using BlockPointer = std::shared_ptr<Block>;  // the pipeline copies it
  bool stopped = false;
  const auto read = [&](tbb::flow_control& flow) {
    auto block = std::make_shared<Block>();
    block->first = reader->position() == 0;
    stopped = stop && stop();
    if (stopped || !reader->Read(kBlockFrames, &block->frames)) flow.stop();
    return block;
  };
  const auto estimate = [&](BlockPointer block) {
    Estimate(finger, scene, pool, block.get());
    return block;
  };
  const auto hand_over = [&](BlockPointer block) { write(block->result); };

  using tbb::filter_mode;
  threads = std::max(1, threads);
  // As many as asked for, also if the machine has fewer.
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                  static_cast<std::size_t>(threads));
  tbb::task_arena(threads).execute([&] {
    tbb::parallel_pipeline(static_cast<std::size_t>(threads * kBlocksPerThread),
                           tbb::make_filter<void, BlockPointer>(
                               filter_mode::serial_in_order, read) &
                               tbb::make_filter<BlockPointer, BlockPointer>(
                                   filter_mode::parallel, estimate) &
                               tbb::make_filter<BlockPointer, void>(
                                   filter_mode::serial_in_order, hand_over));
  });
  return !stopped;
}

}  // namespace finray
