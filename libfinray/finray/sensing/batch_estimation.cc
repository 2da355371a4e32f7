#include "finray/sensing/batch_estimation.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>

#include "finray/sensing/frame_results.h"
#include "finray/sensing/frame_solver.h"

namespace finray {

std::vector<FrameEstimate> EstimateFrames(
    const Finger& finger, const Scene& scene,
    const Discretization& discretization,
    const std::vector<FrameReadings>& readings, int threads) {
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

EstimationSummary EstimateLog(const Finger& finger, const Scene& scene,
                              const Discretization& discretization, int threads,
                              FrameTable* log) {
  const auto readings = ReadReadings(finger, *log);
  const std::vector<FrameEstimate> estimates =
      EstimateFrames(finger, scene, discretization, readings, threads);
  FillResults(finger, scene, readings, estimates, log);
  const std::vector<double> force = log->NumbersOrNan("force_N");
  EstimationSummary summary;
  for (std::size_t row = 0; row < estimates.size(); ++row) {
    summary.Add(estimates[row], scene.friction_coefficient, force[row]);
  }
  return summary;
}

}  // namespace finray
