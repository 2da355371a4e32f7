#ifndef FINRAY_CALIB_SOLVE_ROBUST_SOLVE_H_
#define FINRAY_CALIB_SOLVE_ROBUST_SOLVE_H_

#include <string>
#include <vector>

#include "finray/calib/problem/calibration_problem.h"
#include "finray/calib/solve/contact_store.h"
#include "finray/calib/solve/joint_solve.h"
#include "finray/calib/solve/linearization.h"

namespace finray {

/// Says where one start ended.
struct StartReport {
  std::string name;
  SolveReport solve;
  /// The distance to the best solution in standard deviations, sqrt(dx' (S + P)
  /// dx).
  double distance_std = 0;
  bool agrees = false;  ///< It converged, nearer than kSameSolution.
  static constexpr double kSameSolution = 0.1;
};

/// The solution of a calibration. Its values and rejected frames are in the
/// CalibrationProblem.
struct CalibrationSolution {
  SolveReport solve;
  Linearization at;                 ///< The fitted frames at the solution.
  Contacts contacts;                ///< NaN for frames that are not fitted.
  std::vector<StartReport> starts;  ///< The given finger comes first.
  int rounds = 0;                   ///< Number of rounds of rejection.
  bool settled = false;  ///< The last round has rejected the same frames.
  bool outliers_too_many = false;

  /// The number of starts that agree.
  int agreeing() const;
};

/// Solves from several starts, goes on from the best one, and solves again
/// without the outliers until these stay the same.
///
///   1. SolveJointly solves StartFrames() from each start.
///      Before that, a few iterations from the given start show which frames
///      are far out. With them the starts would take long and end in basins of
///      their own.
///      At their solution DecideContacts decides what was left open.
///   2. SolveSummed solves all frames, from the start with the least cost. If
///      there are more than 4 kStageFrames, it first solves kStageFrames of
///      them, which saves the others a step or two.
///   3. FindOutliers judges the frames. While the outliers change, step 2 is
///      repeated.
CalibrationSolution SolveRobustly(CalibrationProblem* problem);
constexpr std::size_t kStageFrames = 20000;

/// Evenly spread frames that tell each free parameter some thirty measurements:
/// kLeastStartFrames or more, kMostStartFrames at most.
std::vector<int> StartFrames(const CalibrationProblem& problem);
constexpr std::size_t kLeastStartFrames = 100, kMostStartFrames = 250;

/// Solves from the present values, with steps 1 and 2, and rejects nothing.
/// Step 2 is repeated until what the rows before leave unknown of a reading,
/// and which way friction pulls, stay the same.
CalibrationSolution SolveOnce(CalibrationProblem* problem);

}  // namespace finray

#endif  // FINRAY_CALIB_SOLVE_ROBUST_SOLVE_H_
