#include "finray/batch/batch_estimation.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <mutex>

namespace finray {

FrameSolverFactory FrameSolvers(const Finger& finger, const Scene& scene,
                                const Discretization& discretization,
                                FrameMethod method) {
  // The estimators of all threads share the tables of this one.
  struct First {
    std::once_flag made;
    std::unique_ptr<const FrameEstimator> estimator;
  };
  return [=, first = std::make_shared<First>()] {
    std::call_once(first->made, [&] {
      first->estimator = std::make_unique<const FrameEstimator>(
          finger, scene, discretization, method);
    });
    const std::shared_ptr<FrameEstimator> estimator =
        first->estimator->ForAnotherThread();
    return [estimator](const Measurements* readings, std::size_t count,
                       FrameEstimate* estimates) {
      estimator->EstimateBlock(readings, count, estimates);
    };
  };
}

struct FrameSolverPool::Solvers {
  tbb::enumerable_thread_specific<FrameSolver> of_thread;
};

FrameSolverPool::FrameSolverPool(const FrameSolverFactory& make)
    : solvers_(
          new Solvers{tbb::enumerable_thread_specific<FrameSolver>(make)}) {
  solvers_->of_thread.local();
}

FrameSolverPool::~FrameSolverPool() = default;

void FrameSolverPool::SolveBlock(const Measurements* readings,
                                 std::size_t count, FrameEstimate* estimates) {
  solvers_->of_thread.local()(readings, count, estimates);
}

std::vector<FrameEstimate> EstimateFrames(
    const Finger& finger, const Scene& scene,
    const Discretization& discretization,
    const std::vector<Measurements>& readings, int threads) {
  return EstimateFrames(FrameSolvers(finger, scene, discretization), readings,
                        threads);
}

std::vector<FrameEstimate> EstimateFrames(
    const FrameSolverFactory& make, const std::vector<Measurements>& readings,
    int threads) {
  std::vector<FrameEstimate> estimates(readings.size());
  FrameSolverPool pool(make);
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
