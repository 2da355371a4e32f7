#ifndef FINRAY_CHAIN_FINGER_JACOBIAN_H_
#define FINRAY_CHAIN_FINGER_JACOBIAN_H_

#include <Eigen/Core>

#include "finray/chain/finger_equations.h"

namespace finray {

/// The blocks of (13) and (24) that are not constant or zero; S_e is
/// ChainLayout::gauges, d tau / d F_t is -J_t^T.
struct TorqueJacobian {
  Eigen::MatrixXd theta;    ///< K - K_J - d(J_c^T F_c)/d theta, n x n.
  Eigen::MatrixXd loads;    ///< [-J_t^T | d tau / d f], n x (3 + r).
  Eigen::MatrixXd contact;  ///< [d tau / d l_c | -J_c^T W_c], n x 2.
};

/// (22), (23), (26) to (28). The derivative by l_c is that of the link which
/// holds l_c.
TorqueJacobian MakeTorqueJacobian(const ChainLayout& layout,
                                  const ChainPoses<double>& poses,
                                  const double* loads, const double* contact,
                                  double friction);

/// d r_L and d (r_L - r_R) by theta, 2 x n each: Gamma_L J_L and
/// Gamma_L J_L - Gamma_R J_R of (21).
struct RibMotion {
  Eigen::Matrix2Xd left, across;
};
RibMotion MakeRibMotion(const ChainRib& rib, const RibFrame<double>& frame,
                        const ChainPoses<double>& poses);

/// d d / d theta of (21), r x n.
Eigen::MatrixXd RibJacobian(const ChainLayout& layout,
                            const ChainPoses<double>& poses);

/// The Jacobian of FingerEquations by (theta, loads, contact),
/// (n + 3 + r) x (n + 3 + r + 2); without its last two columns it is (13).
Eigen::MatrixXd FingerJacobian(const ChainLayout& layout, const double* theta,
                               const double* loads, const double* contact,
                               double friction);

}  // namespace finray

#endif  // FINRAY_CHAIN_FINGER_JACOBIAN_H_
