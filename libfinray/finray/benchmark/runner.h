#ifndef FINRAY_BENCHMARK_RUNNER_H_
#define FINRAY_BENCHMARK_RUNNER_H_

#include <memory>
#include <vector>

#include "finray/benchmark/benchmark_case.h"

namespace finray {

/// A solver at work on a case: what the benchmark knows of any.
class Runner {
 public:
  virtual ~Runner() = default;

  /// Not timed: to where a lead-in frame leaves the solver.
  virtual void Start(int lead_in) = 0;
  /// Timed: frames first .. first + count - 1, at most kStretchFrames, which
  /// follow the lead-in or the last ones.
  virtual void Run(int first, int count) = 0;
  /// Not timed: the answer to the k-th frame of the last Run.
  virtual FrameAnswer Answer(int k) = 0;
  /// Unknowns of a frame.
  virtual int unknowns() const = 0;
};

// Each file of these has one family of solvers. `links` is the n of the paper's
// chain.

/// Forward: the paper's Newton on the dense chain (chain/forward.h).
std::unique_ptr<Runner> MakePaperForward(const BenchmarkCase& c, int links);
/// Sensing: the paper's (18) (chain/sensing.h).
std::unique_ptr<Runner> MakePaperSensing(const BenchmarkCase& c, int links);

/// The linear solvers that ceres::Solve is run with on the chain.
enum class CeresLinearSolver {
  kDenseQr,
  kDenseNormalCholesky,
  kSparseNormalCholesky
};
std::unique_ptr<Runner> MakeCeresForward(const BenchmarkCase& c, int links,
                                         CeresLinearSolver linear_solver);
std::unique_ptr<Runner> MakeCeresSensing(const BenchmarkCase& c, int links,
                                         CeresLinearSolver linear_solver);

/// Forward on the ladder of any scheme, to a tolerance; `cold`: every frame
/// from the undeformed finger. With an object its contact is found.
std::unique_ptr<Runner> MakeLadderForward(const BenchmarkCase& c,
                                          const Discretization& discretization,
                                          double tolerance, bool cold);

/// Sensing by ContactFit, frame by frame, each from the one before.
std::unique_ptr<Runner> MakeFit(const BenchmarkCase& c,
                                const Discretization& discretization,
                                double tolerance);
/// Sensing by FrameGroupFit, four frames in vector lanes.
std::unique_ptr<Runner> MakeLanes(const BenchmarkCase& c,
                                  const Discretization& discretization,
                                  double tolerance);

/// All that finray_estimate does with a frame, by FrameEstimator.
enum class EstimatorUse {
  kBlock,   ///< As for logs: blocks of kBlockFrames, the first one searched.
  kLive,    ///< As for --follow: frame by frame.
  kSearch,  ///< Every frame on its own.
};
std::unique_ptr<Runner> MakeEstimator(const BenchmarkCase& c,
                                      const Discretization& discretization,
                                      EstimatorUse use);

}  // namespace finray

#endif  // FINRAY_BENCHMARK_RUNNER_H_
