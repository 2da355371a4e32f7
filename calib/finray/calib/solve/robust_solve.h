#ifndef FINRAY_CALIB_SOLVE_ROBUST_SOLVE_H_
#define FINRAY_CALIB_SOLVE_ROBUST_SOLVE_H_

#include <string>
#include <vector>

#include "finray/calib/problem/calibration_problem.h"
#include "finray/calib/solve/contact_store.h"
#include "finray/calib/solve/joint_solve.h"
#include "finray/calib/solve/linearization.h"

namespace finray {

/// Where one start led to.
struct StartReport {
  std::string name;
  bool converged = false;
  int iterations = 0;
  double cost = 0;
  /// To the best one: sqrt(dx' (S + P) dx), in standard deviations.
  double distance_std = 0;
  bool agrees = false;  ///< converged, and nearer than kSameSolution
  static constexpr double kSameSolution = 0.1;
};

/// The problem has the values of the solution and its rejected frames.
struct CalibrationSolution {
  SolveReport solve;
  Linearization at;                 ///< of the fitted frames
  Contacts contacts;                ///< NaN for frames that are not fitted
  std::vector<StartReport> starts;  ///< the given one first
  int rounds = 0;                   ///< of rejection
  bool settled = false;  ///< the rejected frames are what the solution says
  bool outliers_too_many = false;
};

/// Solves from several starts, goes on from the best, and solves again without
/// the frames that are outliers, until these stay the same.
///
///   1. kStartFrames frames, evenly spread, from each start: SolveJointly. A
///      few iterations from the given start show first which of them are far
///      out; these would make the starts long, and basins of their own.
///   2. All frames, from the start with the least cost: SolveSummed. A log of
///      more than 4 kStageFrames first has kStageFrames of them, which spares
///      the others a step or two.
///   3. FindOutliers; while they change, 2 again.
CalibrationSolution SolveRobustly(CalibrationProblem* problem);
constexpr std::size_t kStartFrames = 250, kStageFrames = 20000;

/// Solves once from the present values, by 1 and 2, and rejects nothing.
CalibrationSolution SolveOnce(CalibrationProblem* problem);

}  // namespace finray

#endif  // FINRAY_CALIB_SOLVE_ROBUST_SOLVE_H_
