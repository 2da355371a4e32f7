#include "finray/sensing/frame_solver.h"

#include <tbb/enumerable_thread_specific.h>

#include <utility>

namespace finray {
namespace {

class ColdSolver : public FrameSolver {
 public:
  ColdSolver(const Finger& finger, const Scene& scene,
             const Discretization& discretization)
      : estimator_(finger, scene, discretization) {}

  FrameEstimate Solve(const std::vector<double>& readings_V,
                      const FrameEstimate* /*before*/) override {
    return estimator_.Estimate(readings_V);
  }

 private:
  FrameEstimator estimator_;
};

}  // namespace

FrameSolverFactory ColdSolvers(const Finger& finger, const Scene& scene,
                               const Discretization& discretization) {
  return [finger, scene, discretization] {
    return std::make_unique<ColdSolver>(finger, scene, discretization);
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

void FrameSolverPool::SolveBlock(const std::vector<double>* readings_V,
                                 std::size_t count, FrameEstimate* estimates) {
  std::unique_ptr<FrameSolver>& solver = solvers_->of_thread.local();
  if (!solver) solver = solvers_->make();
  for (std::size_t i = 0; i < count; ++i) {
    estimates[i] =
        solver->Solve(readings_V[i], i == 0 ? nullptr : &estimates[i - 1]);
  }
}

}  // namespace finray
