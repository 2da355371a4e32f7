#ifndef FINRAY_CHAIN_FINGER_JACOBIAN_H_
#define FINRAY_CHAIN_FINGER_JACOBIAN_H_

#include <Eigen/Core>

#include "finray/chain/finger_equations.h"

namespace finray {

/// The derivatives of tau of (14) by all unknowns: the middle rows of (13) and
/// (24).
struct TorqueJacobian {
  Eigen::MatrixXd theta;    ///< K - K_J - d(J_c^T F_c)/d theta, n x n.
  Eigen::MatrixXd loads;    ///< [-J_t^T | d tau / d f], n x (3 + r).
  Eigen::MatrixXd contact;  ///< [d tau / d l_c | -J_c^T W_c], n x 2.
};

/// (22), (23), (26) to (28). The derivative by l_c is the one on the link that
/// holds l_c.
TorqueJacobian MakeTorqueJacobian(const ChainLayout& layout,
                                  const ChainPoses<double>& poses,
                                  const double* loads, const double* contact,
                                  double friction);

/// The Jacobian of FingerEquations by (theta, loads, contact),
/// (n + 3 + r) x (n + 3 + r + 2). Without its last two columns it is (13); its
/// rows of d are those of (21). S_e of (24) is ChainLayout::gauges.
Eigen::MatrixXd FingerJacobian(const ChainLayout& layout, const double* theta,
                               const double* loads, const double* contact,
                               double friction);

}  // namespace finray

#endif  // FINRAY_CHAIN_FINGER_JACOBIAN_H_
