#include "finray/batch/batch_estimation.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>

#include "finray/batch/frame_solver.h"

namespace finray {

std::vector<FrameEstimate> EstimateFrames(
    const Finger& finger, const Scene& scene,
    const Discretization& discretization,
    const std::vector<Measurements>& readings, int threads) {
  std::vector<FrameEstimate> estimates(readings.size());
  FrameSolverPool pool(FrameSolvers(finger, scene, discretization));
  const std::size_t blocks =
      (readings.size() + kBlockFrames - 1) / kBlockFrames;
  tbb::task_arena(std::max(1, threads)).execute([&] {
    tbb::parallel_for(std::size_t{0}, blocks, [&](std::size_t block) {
      const std::size_t begin = block * kBlockFrames;
      const std::size_t end = std::min(begin + kBlockFrames, readings.size());
      pool.SolveBlock(&readings[begin], end - begin, &estimates[begin]);
    });
  });
  return estimates;
}

}  // namespace finray
