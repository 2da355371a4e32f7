#ifndef FINRAY_CHAIN_CERES_CHAIN_H_
#define FINRAY_CHAIN_CERES_CHAIN_H_

#include <ceres/types.h>

#include "finray/chain/sensing.h"

namespace finray {

// The paper's chain solved by ceres::Solve, for the benchmark: the rows of
// ScaledEquations are one residual block over the parameter blocks theta (n),
// (F_t, f) (3 + r) and (l_c, f_c) (2).

/// ContinueForward (forward.h) with ceres::Solve in place of Newton (6). There
/// are as many equations as unknowns, so the cost falls to rounding. Returns
/// false and leaves `state` unchanged if it does not. Sets `iterations` if it
/// is given.
bool ContinueForwardWithCeres(const ChainLayout& layout,
                              const PointContact& contact,
                              ceres::LinearSolverType linear_solver,
                              ChainState* state, int* iterations = nullptr);

/// SenseContact (sensing.h) with ceres::Solve in place of Newton (18), from the
/// equilibrium under `start` and with the same bounds. Both kinds of rows are
/// divided by `gauge_std_rad`, which leaves the minimum where it is.
///
/// Two things differ from SenseContact. Ceres wants the cost to fall with every
/// step, but the cost jumps where l_c passes a joint (x_c turns by theta_i
/// there): Ceres stops at the joint where Newton passes it. So `start` should
/// lie on the link of the solution; a result at a joint or on a bound has not
/// converged. And Ceres compares costs, which resolve a minimum to the root of
/// rounding: exact gauges give Newton's l_c to 1e-11 mm, noisy ones to 1e-6 mm.
///
/// Normal equations square the ratio of the model's weight to the gauges', so
/// they keep fewer digits than QR does.
ChainSensing SenseContactWithCeres(
    const ChainLayout& layout, const Eigen::VectorXd& s0,
    const PointContact& start, double gauge_std_rad = 3e-4,
    const ChainSensingOptions& options = {},
    ceres::LinearSolverType linear_solver = ceres::DENSE_QR);

}  // namespace finray

#endif  // FINRAY_CHAIN_CERES_CHAIN_H_
