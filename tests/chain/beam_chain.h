#ifndef FINRAY_TESTS_CHAIN_BEAM_CHAIN_H_
#define FINRAY_TESTS_CHAIN_BEAM_CHAIN_H_

#include <Eigen/Core>
#include <Eigen/LU>

#include "finray/chain/forward.h"

namespace finray {

// A single flexible beam whose two ends are held (Section II.B): the paper's
// first example, as a check of the chain. Unknowns (theta, F_t), equations
//
//   C(theta, F_t) = [ y   = ln(g_st g_t^-1)^vee    ]            (4)
//                   [ tau = K theta - J_t^T F_t    ] = 0.

/// A straight beam along +x from the origin, clamped there: n segments of equal
/// length with a joint in the middle of each.
inline ElasticChain MakeStraightBeam(double length_mm, double stiffness_N_mm2,
                                     int n) {
  ElasticChain beam;
  const double segment = length_mm / n;
  for (int i = 0; i < n; ++i) {
    beam.Add({(i + 0.5) * segment, 0}, stiffness_N_mm2 / segment);
  }
  beam.tip_rest.t = {length_mm, 0};
  return beam;
}

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
inline Eigen::MatrixXd BeamJacobian(const ElasticChain& beam,
                                    const Pose<double>& target,
                                    const Eigen::VectorXd& theta,
                                    const Eigen::Vector3d& tip) {
  const int n = beam.joints();
  const ChainPoses<double> poses = Kinematics(beam, theta.data());
  Eigen::MatrixXd jacobian = Eigen::MatrixXd::Zero(n + 3, n + 3);
  jacobian.topLeftCorner(3, n) = TipDeviationJacobian(beam, poses, target);
  jacobian.block(3, 0, n, n).diagonal() = beam.stiffness;
  SubtractWrenchStiffness(poses, tip.replicate(1, n),
                          jacobian.block(3, 0, n, n));
  jacobian.bottomRightCorner(n, 3) = -poses.xi.transpose();
  return jacobian;
}

struct BeamState {
  Eigen::VectorXd theta;                          ///< n joint angles, rad.
  Eigen::Vector3d tip = Eigen::Vector3d::Zero();  ///< F_t on the beam's end.
};

/// Newton (6) from `state`. It subtracts the step (the print adds it) and
/// shortens steps so that no link turns by more than half a radian. Returns
/// false and leaves `state` unchanged if it does not converge. Bend the start a
/// little: a straight one has a rank-deficient J_t.
inline bool SolveBeam(const ElasticChain& beam, const Pose<double>& target,
                      BeamState* state) {
  const int n = beam.joints();
  // Rows and columns in units of the beam: its length, and the moment and force
  // that bend it by about a radian.
  const double length = beam.tip_rest.t.norm();
  const double moment = 1 / beam.stiffness.cwiseInverse().sum();
  Eigen::VectorXd row_unit = Eigen::VectorXd::Constant(n + 3, moment);
  row_unit.head<3>() << 1, length, length;
  Eigen::VectorXd column_unit = Eigen::VectorXd::Ones(n + 3);
  column_unit.tail<3>() << moment, moment / length, moment / length;

  BeamState at = *state;
  for (int iteration = 0; iteration < 100; ++iteration) {
    const Eigen::VectorXd c =
        BeamEquations<double>(beam, target, at.theta.data(), at.tip)
            .cwiseQuotient(row_unit);
    const Eigen::MatrixXd jacobian =
        row_unit.cwiseInverse().asDiagonal() *
        BeamJacobian(beam, target, at.theta, at.tip) * column_unit.asDiagonal();
    const Eigen::VectorXd step = -jacobian.partialPivLu().solve(c);
    if (!step.allFinite()) return false;
    const double turn = LargestTurn(step.head(n));
    const double fraction = turn > 0.5 ? 0.5 / turn : 1;
    at.theta += fraction * step.head(n);
    at.tip += fraction * step.tail<3>().cwiseProduct(column_unit.tail<3>());
    // Newton is quadratic: after a step this small nothing is left to gain.
    if (step.cwiseAbs().maxCoeff() < 1e-9) {
      *state = at;
      return true;
    }
  }
  return false;
}

}  // namespace finray

#endif  // FINRAY_TESTS_CHAIN_BEAM_CHAIN_H_
