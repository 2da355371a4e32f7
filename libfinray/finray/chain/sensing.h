#ifndef FINRAY_CHAIN_SENSING_H_
#define FINRAY_CHAIN_SENSING_H_

#include <Eigen/Core>

#include "finray/chain/chain_state.h"

namespace finray {

struct ChainSensingOptions {
  /// What y, tau and d in their units (ChainUnits) count against gauge rows in
  /// rad. The model should hold exactly and noise should stay in the gauges;
  /// the paper's N mm, mm and rad side by side let either give way.
  double model_weight = 1e6;
  int max_iterations = 60;
};

struct ChainSensing {
  bool converged = false;
  int iterations = 0;
  ChainContact contact;  ///< l_c, f_c; friction as given.
  ChainState state;
  Eigen::VectorXd misfit;  ///< s of (16), rad.
};

/// Where both ways of sensing start: the equilibrium under `start` and what it
/// misfits. False if there is none or s0 is not finite.
bool StartSensing(const ChainLayout& layout, const Eigen::VectorXd& s0,
                  const ChainContact& start, ChainSensing* result);

/// Contact from gauge angles s_0 (m, rad): the overdetermined Newton (18) on
/// C(theta, F_t, f, l_c, f_c) of (17), n + 3 + r + m rows for n + 3 + r + 2
/// unknowns. Its pseudo-inverse is a column-pivoted QR of the weighted rows, y,
/// tau and d above s: Householder QR wants the heavy rows first.
///
/// It starts from the equilibrium under `start`, whose friction is kept. Steps
/// are shortened so that no link turns by more than 0.5 rad, l_c moves by no
/// more than 3 % of l_0 (beyond the next rib its force is of no use as a start)
/// and f_c by no more than 30 % of f_c + F_0. l_c stays on the beam and
/// f_c >= 0; a solution on such a bound has not converged. `converged` is
/// false, and nothing is NaN, where it fails.
ChainSensing SenseContact(const ChainLayout& layout, const Eigen::VectorXd& s0,
                          const ChainContact& start,
                          const ChainSensingOptions& options = {});

}  // namespace finray

#endif  // FINRAY_CHAIN_SENSING_H_
