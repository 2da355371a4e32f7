#ifndef FINRAY_SENSING_FRAME_SOLVER_H_
#define FINRAY_SENSING_FRAME_SOLVER_H_

#include <cstddef>
#include <functional>
#include <memory>
#include <vector>

#include "finray/sensing/frame_estimator.h"

namespace finray {

/// What the batch code knows of an estimator: gauges in, estimate out.
class FrameSolver {
 public:
  virtual ~FrameSolver() = default;

  /// `readings_V`: one per gauge, NaN where not measured. `before` is what the
  /// frame before came to, a place to start from; null for a cold start. The
  /// result depends on nothing else.
  virtual FrameEstimate Solve(const std::vector<double>& readings_V,
                              const FrameEstimate* before) = 0;
};

using FrameSolverFactory = std::function<std::unique_ptr<FrameSolver>()>;

/// Makes solvers that start every frame cold, by FrameEstimator, whose errors
/// they throw.
FrameSolverFactory ColdSolvers(const Finger& finger, const Scene& scene,
                               const Discretization& discretization);

/// Frames that follow each other from one cold start. Blocks lie at fixed
/// places of a log: frame i is in block i / kBlockFrames. So the results depend
/// neither on threads nor on how a log is read.
constexpr std::size_t kBlockFrames = 64;

/// A solver for each thread, made when the thread first needs it.
class FrameSolverPool {
 public:
  /// Makes one solver, so that a bad finger or scene is reported here.
  explicit FrameSolverPool(FrameSolverFactory make);
  ~FrameSolverPool();

  /// Estimates a block (of `count` frames, fewer at the end of a log), from any
  /// thread.
  void SolveBlock(const std::vector<double>* readings_V, std::size_t count,
                  FrameEstimate* estimates);

 private:
  struct Solvers;
  std::unique_ptr<Solvers> solvers_;
};

}  // namespace finray

#endif  // FINRAY_SENSING_FRAME_SOLVER_H_
