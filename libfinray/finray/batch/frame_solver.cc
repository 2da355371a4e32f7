#include "finray/batch/frame_solver.h"

#include <tbb/enumerable_thread_specific.h>

#include <utility>

namespace finray {
namespace {

class EstimatorSolver : public FrameSolver {
 public:
  EstimatorSolver(const Finger& finger, const Scene& scene,
                  const Discretization& discretization, FrameMethod method)
      : estimator_(finger, scene, discretization, method) {}

  void SolveBlock(const Measurements* readings, std::size_t count,
                  FrameEstimate* estimates) override {
    estimator_.EstimateBlock(readings, count, estimates);
  }

 private:
  FrameEstimator estimator_;
};

}  // namespace

FrameSolverFactory FrameSolvers(const Finger& finger, const Scene& scene,
                                const Discretization& discretization,
                                FrameMethod method) {
  return [finger, scene, discretization, method] {
    return std::make_unique<EstimatorSolver>(finger, scene, discretization,
                                             method);
  };
}

struct FrameSolverPool::Solvers {
  FrameSolverFactory make;
  tbb::enumerable_thread_specific<std::unique_ptr<FrameSolver>> of_thread;
};

FrameSolverPool::FrameSolverPool(FrameSolverFactory make)
    : solvers_(std::make_unique<Solvers>()) {
  solvers_->make = std::move(make);
  solvers_->of_thread.local() = solvers_->make();
}

FrameSolverPool::~FrameSolverPool() = default;

void FrameSolverPool::SolveBlock(const Measurements* readings,
                                 std::size_t count, FrameEstimate* estimates) {
  std::unique_ptr<FrameSolver>& solver = solvers_->of_thread.local();
  if (!solver) solver = solvers_->make();
  solver->SolveBlock(readings, count, estimates);
}

}  // namespace finray
