#include "finray/chain/beam_chain.h"

#include <Eigen/LU>
#include <cmath>

#include "finray/chain/newton_step.h"

namespace finray {

ElasticChain MakeStraightBeam(double length_mm, double stiffness_N_mm2, int n) {
  ElasticChain beam;
  const double segment = length_mm / n;
  for (int i = 0; i < n; ++i) {
    beam.Add({(i + 0.5) * segment, 0}, stiffness_N_mm2 / segment);
  }
  beam.tip_rest.t = {length_mm, 0};
  return beam;
}

Eigen::MatrixXd BeamJacobian(const ElasticChain& beam,
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

bool SolveBeam(const ElasticChain& beam, const Pose<double>& target,
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
