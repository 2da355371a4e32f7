#include "finray/chain/elastic_chain.h"

namespace finray {

void ElasticChain::Add(const Eigen::Vector2d& point, double joint_stiffness) {
  const int n = joints();
  twists.conservativeResize(3, n + 1);
  stiffness.conservativeResize(n + 1);
  twists.col(n) = RevoluteTwist<double>(point);
  stiffness[n] = joint_stiffness;
}

Eigen::Matrix3Xd TipDeviationJacobian(const ElasticChain& chain,
                                      const ChainPoses<double>& poses,
                                      const Pose<double>& target) {
  return LogJacobian(TipPose(chain, poses) * target.Inverse()) * poses.xi;
}

void SubtractWrenchStiffness(const ChainPoses<double>& poses,
                             const Eigen::Matrix3Xd& beyond,
                             Eigen::Ref<Eigen::MatrixXd> out) {
  const int n = static_cast<int>(poses.xi.cols());
  for (int j = 0; j < n; ++j) {
    const Twist<double> xi_j = poses.xi.col(j);
    for (int i = j + 1; i < n; ++i) {
      out(i, j) -= Bracket<double>(xi_j, poses.xi.col(i)).dot(beyond.col(i));
    }
  }
}

}  // namespace finray
