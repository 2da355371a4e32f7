#ifndef FINRAY_CHAIN_SENSING_H_
#define FINRAY_CHAIN_SENSING_H_

#include <Eigen/Core>

#include "finray/chain/forward.h"
#include "finray/finger/point_contact.h"

namespace finray {

struct ChainSensingOptions {
  /// Weight of the model's rows (ScaledEquations) against gauge rows in rad.
  /// With a large weight the model holds exactly and noise stays in the gauges.
  /// The paper puts N mm, mm and rad side by side, which lets either give way.
  double model_weight = 1e6;
  int max_iterations = 60;
};

struct ChainSensing {
  bool converged = false;
  int iterations = 0;
  PointContact contact;  ///< l_c and f_c; friction as given.
  ChainState state;
  Eigen::VectorXd misfit;  ///< s of (16), rad.
};

/// Fills `result` with the start of both ways of sensing: the equilibrium under
/// `start` and its misfit. False if there is none or s0 is not finite.
bool StartSensing(const ChainLayout& layout, const Eigen::VectorXd& s0,
                  const PointContact& start, ChainSensing* result);

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
                          const ChainSensingOptions& options = {});

}  // namespace finray

#endif  // FINRAY_CHAIN_SENSING_H_
