#ifndef FINRAY_CALIB_SOLVE_ROBUST_SOLVE_H_
#define FINRAY_CALIB_SOLVE_ROBUST_SOLVE_H_

#include <string>
#include <vector>

#include "finray/calib/problem/calibration_problem.h"

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

struct RobustSolution {
  SolveReport solve;
  std::vector<StartReport> starts;  ///< the given one first
  int rounds = 0;                   ///< of rejection
  bool settled = false;  ///< the rejected frames are what the solution says
  bool outliers_too_many = false;
};

/// Solves from several starts, goes on from the best, and solves again without
/// the frames that are outliers, until these stay the same. Starts are compared
/// on at most CalibrationProblem::kSome frames, without those that a few
/// iterations from the given start leave far out: these make it long, and
/// basins of their own.
RobustSolution SolveRobustly(CalibrationProblem* problem);

}  // namespace finray

#endif  // FINRAY_CALIB_SOLVE_ROBUST_SOLVE_H_
