#ifndef FINRAY_CALIB_ANALYSIS_WIDE_LINEARIZATION_H_
#define FINRAY_CALIB_ANALYSIS_WIDE_LINEARIZATION_H_

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <unordered_map>
#include <vector>

#include "finray/calib/problem/calibration_problem.h"
#include "finray/calib/solve/robust_solve.h"

namespace finray {

/// The fitted frames at a solution, linearised once with all candidate effects
/// free as well, in folds: blocks of neighbouring rows, dealt out in turn.
struct WideLinearization {
  static constexpr int kFolds = 5;
  /// A log is cut into as many equal stretches of rows, if logs are few: into
  /// kMostStretches / logs.
  static constexpr int kMostStretches = 16, kMostOfLog = 8;
  struct Stretch {
    int log = 0, first_row = 0;
  };
  static constexpr std::size_t kMostChecked = 1000;
  /// Its plan frees the candidates too. Its values are those of the solution.
  std::unique_ptr<CalibrationProblem> problem;
  std::vector<std::vector<int>> frames;  ///< Of each fold.
  /// The stretches of all logs in their order, and the stretch of each frame of
  /// the logs. In `folds` they take the place of logs.
  std::vector<Stretch> stretches;
  std::vector<int> stretch_of;
  std::vector<Linearization> folds;
  /// Frames of each fold that CrossValidate estimates, evenly spread and
  /// kMostChecked of all, and the derivatives of what their gauges read: V by
  /// the free parameters of the solved problem, a row for each gauge.
  std::vector<std::vector<int>> checked;
  std::unordered_map<int, Eigen::MatrixXd> readings_V;
  /// The columns of the free parameters of the solved problem, in their order,
  /// and those of the candidates.
  std::vector<Eigen::Index> free, candidates;
};
WideLinearization LinearizeWide(const CalibrationProblem& problem,
                                const CalibrationSolution& solution);
/// The same with few candidates, for CrossValidatedLogLikelihood: those that
/// let the forces of free frames count (Plan::ForceZeroIsKnown), so that the
/// same measurements are predicted whatever the plan frees.
WideLinearization LinearizeFolds(const CalibrationProblem& problem,
                                 const CalibrationSolution& solution);

}  // namespace finray

#endif  // FINRAY_CALIB_ANALYSIS_WIDE_LINEARIZATION_H_
