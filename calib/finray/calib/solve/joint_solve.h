#ifndef FINRAY_CALIB_SOLVE_JOINT_SOLVE_H_
#define FINRAY_CALIB_SOLVE_JOINT_SOLVE_H_

#include <ceres/solver.h>

#include <string>
#include <vector>

#include "finray/calib/problem/calibration_problem.h"
#include "finray/calib/solve/contact_store.h"

namespace finray {

/// Says how a solve went.
struct SolveReport {
  bool converged = false;
  int iterations = 0;
  double initial_cost = 0;
  double final_cost = 0;
  std::string message;
  bool exhausted = false;  ///< It has reached the bound of its work.
};
SolveReport ReportOf(const ceres::Solver::Summary& summary);

struct JointLimits {
  int iterations;
  /// The solve ends after a step that lowers the cost by less than this share.
  double function_tolerance;
  /// So does an undamped step that lowers it by less than this.
  double least_decrease = 0;
};

/// Solves for the parameters and the contacts of these frames in one
/// ceres::Problem. Ceres eliminates the contacts (DENSE_SCHUR). The solve finds
/// its way from far, because no contact has to be where it explains its frame
/// best before the gains are known. Memory and time grow with the frames. Some
/// hundred frames come near enough to the solution for SolveSummed.
SolveReport SolveJointly(const std::vector<int>& frames,
                         const JointLimits& limits, CalibrationProblem* problem,
                         ContactStore* contacts);

}  // namespace finray

#endif  // FINRAY_CALIB_SOLVE_JOINT_SOLVE_H_
