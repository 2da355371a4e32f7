#ifndef FINRAY_CHAIN_SENSING_H_
#define FINRAY_CHAIN_SENSING_H_

#include <ceres/types.h>

#include <Eigen/Core>

#include "finray/chain/forward.h"
#include "finray/finger/point_contact.h"

namespace finray {

/// Weight of the model's rows (ScaledEquations) against gauge rows in rad. With
/// a large weight the model holds exactly and noise stays in the gauges. The
/// paper puts N mm, mm and rad side by side, which lets either give way.
constexpr double kHeavyModel = 1e6;

struct ChainSensing {
  bool converged = false;
  int iterations = 0;
  PointContact contact;  ///< l_c and f_c; friction as given.
  ChainState state;
  Eigen::VectorXd misfit;  ///< s of (16), rad.
};

/// Finds the contact from gauge angles s_0 (m, rad) by the overdetermined
/// Newton (18) on C(theta, F_t, f, l_c, f_c) of (17), n + 3 + r + m rows for n
/// + 3 + r + 2 unknowns. A column-pivoted QR of the weighted rows serves as the
/// pseudo-inverse; the heavy rows come first, as Householder QR needs them.
///
/// It starts from the equilibrium under `start` and keeps its friction. Steps
/// are shortened so that no link turns by more than 0.5 rad, l_c moves by at
/// most 3 % of l_0 (beyond the next rib the present state is no start) and f_c
/// changes by at most 30 % of f_c + F_0. l_c stays on the beam and f_c >= 0; a
/// result on such a bound has not converged. If it fails, `converged` is false
/// and no number is NaN.
ChainSensing SenseContact(const ChainLayout& layout, const Eigen::VectorXd& s0,
                          const PointContact& start,
                          double model_weight = kHeavyModel);

/// SenseContact with ceres::Solve in place of Newton (18), from the
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
    double model_weight = kHeavyModel,
    ceres::LinearSolverType linear_solver = ceres::DENSE_QR);

}  // namespace finray

#endif  // FINRAY_CHAIN_SENSING_H_
