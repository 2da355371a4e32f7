#ifndef FINRAY_BENCHMARK_RUNNER_H_
#define FINRAY_BENCHMARK_RUNNER_H_

#include <ceres/types.h>

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "finray/benchmark/benchmark_case.h"
#include "finray/residuals/frame_evaluation.h"
#include "finray/sensing/contact_search.h"
#include "finray/statics/equilibrium.h"

namespace finray {

/// Runs one solver on the frames of a case. The benchmark knows solvers by this
/// interface alone.
class Runner {
 public:
  explicit Runner(const BenchmarkCase& c);
  virtual ~Runner() = default;

  /// Brings the solver to the solution of a lead-in frame. Not timed.
  virtual void Start(int lead_in) = 0;
  /// Solves frames first .. first + count - 1, at most kStretchFrames, which
  /// follow the lead-in or the frames of the last Run. Timed.
  virtual void Run(int first, int count) = 0;
  /// Returns the answer to the k-th frame of the last Run. Not timed.
  virtual FrameAnswer Answer(int k) { return answers_[k]; }
  /// Returns the number of unknowns of a frame.
  virtual int unknowns() const = 0;

 protected:
  const BenchmarkCase& case_;
  std::vector<FrameAnswer> answers_;  ///< kStretchFrames, allocated.
};

/// A runner whose solver finds contacts on a ladder. Answer adds the gauge
/// angles that these contacts cause in the same discretization.
class SensingRunner : public Runner {
 public:
  SensingRunner(const BenchmarkCase& c, const Discretization& discretization)
      : Runner(c), model_(c.finger, discretization) {}
  FrameAnswer Answer(int k) override;

 protected:
  EquilibriumSolver model_;
};

// Each function below returns a maker of runners for one family of solvers.

using RunnerMaker =
    std::function<std::unique_ptr<Runner>(const BenchmarkCase&)>;

/// Solves the paper's dense chain of `links` links for a known load, with the
/// Newton method of chain/forward.h or with ceres::Solve and `linear_solver`.
RunnerMaker ChainForwardRunner(
    int links, std::optional<ceres::LinearSolverType> linear_solver);
/// Senses a contact on the same chain, with the paper's Newton method (18) of
/// chain/sensing.h or with ceres::Solve.
RunnerMaker ChainSensingRunner(
    int links, std::optional<ceres::LinearSolverType> linear_solver);

/// Solves the ladder for a known load, or for a known object, to a tolerance.
/// `cold`: every frame starts from the undeformed finger.
RunnerMaker LadderForwardRunner(const Discretization& discretization,
                                double tolerance, bool cold);
/// Senses contacts frame by frame with ContactFit; each frame starts from the
/// one before.
RunnerMaker ContactFitRunner(const Discretization& discretization,
                             double tolerance);
/// Senses one contact with FrameGroupFit, four frames in vector lanes.
RunnerMaker FrameGroupRunner(const Discretization& discretization,
                             double tolerance);

/// Senses contacts frame by frame with FrameProblem, that is with ceres::Solve
/// on the residual blocks; each frame starts from the one before.
RunnerMaker CeresFrameRunner(const Discretization& discretization,
                             EquilibriumForm form);

enum class EstimatorUse {
  kBlock,   ///< Blocks of frames, as for logs; only the first is searched.
  kLive,    ///< Frame by frame, as for --follow.
  kSearch,  ///< Every frame is searched on its own.
};
/// Does all that finray_estimate does with a frame, with FrameEstimator.
RunnerMaker EstimatorRunner(const Discretization& discretization,
                            EstimatorUse use,
                            FrameMethod method = FrameMethod::kFast);

/// Makes runners of type R with the arguments that follow the case.
template <class R, class... Args>
RunnerMaker MakerOf(Args... args) {
  return
      [=](const BenchmarkCase& c) { return std::make_unique<R>(c, args...); };
}

}  // namespace finray

#endif  // FINRAY_BENCHMARK_RUNNER_H_
