#ifndef FINRAY_CALIB_SOLVE_WEIGHTED_SOLVE_H_
#define FINRAY_CALIB_SOLVE_WEIGHTED_SOLVE_H_

#include <vector>

#include "finray/calib/solve/joint_solve.h"

namespace finray {

/// SolveJointly in the weighted form, with rising weights of equilibrium: the
/// minimum under a small weight is near the one under a larger weight. A
/// calibration does not use it. It is there to be held against the reduced
/// form, which has 6 + r unknowns fewer a frame
/// (docs/decisions/0002-reduced-equilibrium.md), and for a few frames only
/// (JointProblem). The limits are those of each weight. Not converged if a
/// frame has no equilibrium to start from.
SolveReport SolveJointlyWeighted(const std::vector<int>& frames,
                                 const JointLimits& limits,
                                 CalibrationProblem* problem,
                                 ContactStore* contacts);

}  // namespace finray

#endif  // FINRAY_CALIB_SOLVE_WEIGHTED_SOLVE_H_
