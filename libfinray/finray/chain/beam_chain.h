#ifndef FINRAY_CHAIN_BEAM_CHAIN_H_
#define FINRAY_CHAIN_BEAM_CHAIN_H_

#include <Eigen/Core>

#include "finray/chain/elastic_chain.h"

namespace finray {

// A single flexible beam whose ends are held (Section II.B): unknowns
// (theta, F_t), equations
//
//   C(theta, F_t) = [ y   = ln(g_st g_t^-1)^vee    ]            (4)
//                   [ tau = K theta - J_t^T F_t    ] = 0.

/// A straight beam along +x from the origin, clamped there: n segments of equal
/// length with a joint in the middle of each.
ElasticChain MakeStraightBeam(double length_mm, double stiffness_N_mm2, int n);

/// C of (4), n + 3 rows: y first.
template <typename T>
Eigen::Matrix<T, Eigen::Dynamic, 1> BeamEquations(const ElasticChain& beam,
                                                  const Pose<double>& target,
                                                  const T* theta,
                                                  const Wrench<T>& tip) {
  const int n = beam.joints();
  const ChainPoses<T> poses = Kinematics(beam, theta);
  Eigen::Matrix<T, Eigen::Dynamic, 1> c(n + 3);
  c.template head<3>() = TipDeviation(beam, poses, target);
  for (int i = 0; i < n; ++i) {
    c[3 + i] = beam.stiffness[i] * theta[i] - poses.xi.col(i).dot(tip);
  }
  return c;
}

/// Its Jacobian (5), (n + 3) x (n + 3), columns (theta, F_t).
Eigen::MatrixXd BeamJacobian(const ElasticChain& beam,
                             const Pose<double>& target,
                             const Eigen::VectorXd& theta,
                             const Eigen::Vector3d& tip);

struct BeamState {
  Eigen::VectorXd theta;                          ///< n joint angles, rad.
  Eigen::Vector3d tip = Eigen::Vector3d::Zero();  ///< F_t on the beam's end.
};

/// Newton (6) from `state`, with steps shortened to turn no link by more than
/// half a radian; the printed sign adds the step, which would lead away. False,
/// and `state` as it was, where it does not converge. A straight start has a
/// rank-deficient J_t: bend it a little.
bool SolveBeam(const ElasticChain& beam, const Pose<double>& target,
               BeamState* state);

}  // namespace finray

#endif  // FINRAY_CHAIN_BEAM_CHAIN_H_
