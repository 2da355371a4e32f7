#ifndef FINRAY_BATCH_FRAME_SOLVER_H_
#define FINRAY_BATCH_FRAME_SOLVER_H_

#include <cstddef>
#include <functional>
#include <memory>
#include <vector>

#include "finray/sensing/frame_estimator.h"

namespace finray {

/// What the batch code knows of an estimator: readings in, estimates out.
class FrameSolver {
 public:
  virtual ~FrameSolver() = default;

  /// Estimates `count` frames that follow each other. The result depends on
  /// these readings and on nothing else.
  virtual void SolveBlock(const Measurements* readings, std::size_t count,
                          FrameEstimate* estimates) = 0;
};

using FrameSolverFactory = std::function<std::unique_ptr<FrameSolver>()>;

/// Makes solvers by FrameEstimator, whose errors they throw.
FrameSolverFactory FrameSolvers(const Finger& finger, const Scene& scene,
                                const Discretization& discretization,
                                FrameMethod method = FrameMethod::kFast);

/// Frames that are solved together, the first of them from a cold start. Blocks
/// lie at fixed places of a log: frame i is in block i / kBlockFrames. So the
/// results depend neither on threads nor on how a log is read.
constexpr std::size_t kBlockFrames = 64;

/// A solver for each thread, made when the thread first needs it.
class FrameSolverPool {
 public:
  /// Makes one solver, so that a bad finger or scene is reported here.
  explicit FrameSolverPool(FrameSolverFactory make);
  ~FrameSolverPool();

  /// Estimates a block (of `count` frames, fewer at the end of a log), from any
  /// thread.
  void SolveBlock(const Measurements* readings, std::size_t count,
                  FrameEstimate* estimates);

 private:
  struct Solvers;
  std::unique_ptr<Solvers> solvers_;
};

}  // namespace finray

#endif  // FINRAY_BATCH_FRAME_SOLVER_H_
