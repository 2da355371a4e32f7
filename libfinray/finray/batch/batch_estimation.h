#ifndef FINRAY_BATCH_BATCH_ESTIMATION_H_
#define FINRAY_BATCH_BATCH_ESTIMATION_H_

#include <cstddef>
#include <functional>
#include <memory>
#include <vector>

#include "finray/estimation/frame_estimator.h"

namespace finray {

/// The interface through which the batch code uses an estimator: it estimates
/// `count` consecutive frames. The result depends only on these readings.
using FrameSolver = std::function<void(
    const Measurements* readings, std::size_t count, FrameEstimate* estimates)>;
using FrameSolverFactory = std::function<FrameSolver()>;

/// Returns a factory of solvers that use FrameEstimator and throw its errors.
FrameSolverFactory FrameSolvers(const Finger& finger, const Scene& scene,
                                const Discretization& discretization,
                                FrameMethod method = FrameMethod::kFast);

/// Number of frames that are solved together. The first of them starts cold.
/// Blocks lie at fixed places of a log: frame i is in block i / kBlockFrames.
/// The results therefore depend neither on threads nor on how a log is read.
constexpr std::size_t kBlockFrames = 64;

/// One solver per thread, made when the thread first needs it.
class FrameSolverPool {
 public:
  /// Makes one solver at once, so that a bad finger or scene is reported here.
  explicit FrameSolverPool(const FrameSolverFactory& make);
  ~FrameSolverPool();

  /// Estimates a block from any thread. `count` is kBlockFrames, or less at the
  /// end of a log.
  void SolveBlock(const Measurements* readings, std::size_t count,
                  FrameEstimate* estimates);

 private:
  struct Solvers;
  std::unique_ptr<Solvers> solvers_;
};

/// Estimates all frames, with the same results on any number of threads.
std::vector<FrameEstimate> EstimateFrames(
    const Finger& finger, const Scene& scene,
    const Discretization& discretization,
    const std::vector<Measurements>& readings, int threads);
/// The same with solvers of one's own.
std::vector<FrameEstimate> EstimateFrames(
    const FrameSolverFactory& make, const std::vector<Measurements>& readings,
    int threads);

}  // namespace finray

#endif  // FINRAY_BATCH_BATCH_ESTIMATION_H_
