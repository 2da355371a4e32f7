#ifndef FINRAY_CHAIN_CERES_SENSING_H_
#define FINRAY_CHAIN_CERES_SENSING_H_

#include <ceres/types.h>

#include "finray/chain/sensing.h"

namespace finray {

/// SenseContact with ceres::Solve in place of Newton (18): the same weighted
/// rows as the residual blocks of chain_cost.h, minimised over the full
/// coordinates (theta, F_t, f, l_c, f_c) from the equilibrium under `start`.
/// Gauge rows are whitened by `gauge_std_rad` and the model's rows by the same,
/// which leaves the minimum where SenseContact has it. Bounds are as there.
///
/// Two things set it apart. Ceres wants the cost to fall with every step, and
/// the cost jumps where l_c passes a joint (x_c turns by theta_i): unlike
/// Newton it parks there, so `start` should lie on the link of the solution. A
/// result at a joint or on a bound has not converged. And it compares costs,
/// which resolve a minimum to the root of rounding: exact gauges give Newton's
/// l_c to 1e-11 mm, noisy ones to about 1e-6 mm.
///
/// `linear_solver` takes each step. Normal equations square the model's weight
/// against the gauges', which leaves less of their digits than QR does.
ChainSensing SenseContactWithCeres(
    const ChainLayout& layout, const Eigen::VectorXd& s0,
    const ChainContact& start, double gauge_std_rad = 3e-4,
    const ChainSensingOptions& options = {},
    ceres::LinearSolverType linear_solver = ceres::DENSE_QR);

}  // namespace finray

#endif  // FINRAY_CHAIN_CERES_SENSING_H_
