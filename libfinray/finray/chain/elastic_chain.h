#ifndef FINRAY_CHAIN_ELASTIC_CHAIN_H_
#define FINRAY_CHAIN_ELASTIC_CHAIN_H_

#include <Eigen/Core>
#include <vector>

#include "finray/chain/se2.h"

namespace finray {

/// A chain of n rigid links with elastic revolute joints (Section II.B). It
/// models a beam of any rest shape. A joint angle theta_i is zero in the rest
/// shape and counts the counter-clockwise turn of the links behind joint i
/// against those before it.
struct ElasticChain {
  Eigen::Matrix3Xd twists;    ///< zeta_i of (1), 3 x n.
  Eigen::VectorXd stiffness;  ///< k_i = EI / h of segment i, N mm / rad.
  Pose<double> tip_rest;      ///< g_st,0: {T} at the chain's end at rest.

  int joints() const { return static_cast<int>(stiffness.size()); }
  /// Appends a joint at a point of the rest shape (mm).
  void Add(const Eigen::Vector2d& point, double joint_stiffness) {
    const int n = joints();
    twists.conservativeResize(3, n + 1);
    stiffness.conservativeResize(n + 1);
    twists.col(n) = RevoluteTwist<double>(point);
    stiffness[n] = joint_stiffness;
  }
};

/// The poses of a chain in one configuration.
template <typename T>
struct ChainPoses {
  /// exp(zeta_1 theta_1) .. exp(zeta_i theta_i) for i = 0 .. n.
  std::vector<Pose<T>> after;
  /// xi_i of (3), the joint twists in this configuration, 3 x n. All of it is
  /// J_t; its first columns are the Jacobians of (10).
  Eigen::Matrix<T, 3, Eigen::Dynamic> xi;
};

/// Product of exponentials (1) and spatial Jacobian (3). `theta` has n entries.
template <typename T>
ChainPoses<T> Kinematics(const ElasticChain& chain, const T* theta) {
  const int n = chain.joints();
  ChainPoses<T> poses;
  poses.after.resize(n + 1);
  poses.xi.resize(3, n);
  for (int i = 0; i < n; ++i) {
    const Twist<T> zeta = chain.twists.col(i).cast<T>();
    poses.xi.col(i) = Adjoint(poses.after[i], zeta);
    poses.after[i + 1] = poses.after[i] * Exp<T>(zeta * theta[i]);
  }
  return poses;
}

/// g_st of (1).
template <typename T>
Pose<T> TipPose(const ElasticChain& chain, const ChainPoses<T>& poses) {
  const Pose<double>& g = chain.tip_rest;
  return poses.after.back() * Pose<T>{T(g.c), T(g.s), g.t.cast<T>()};
}

/// y = ln(g_st g_t^-1)^vee of (4): (rad, mm, mm).
template <typename T>
Twist<T> TipDeviation(const ElasticChain& chain, const ChainPoses<T>& poses,
                      const Pose<double>& target) {
  const Pose<double> g = target.Inverse();
  return Log(TipPose(chain, poses) *
             Pose<T>{T(g.c), T(g.s), Vector2<T>(g.t.cast<T>())});
}

/// dy/dtheta, 3 x n. (5) has J_t here, which is exact only where y = 0. This
/// derivative is exact everywhere, as minimisers and tests need it. Newton
/// converges to the same point.
inline Eigen::Matrix3Xd TipDeviationJacobian(const ElasticChain& chain,
                                             const ChainPoses<double>& poses,
                                             const Pose<double>& target) {
  return LogJacobian(TipPose(chain, poses) * target.Inverse()) * poses.xi;
}

/// Subtracts K_J, the first term of (22), from `out` (n x n) for wrenches that
/// are constant in S. Column i of `beyond` (3 x n) is the sum of the wrenches
/// that act beyond joint i. K_J(i, j) = [xi_j, xi_i] . beyond_i for j < i and 0
/// elsewhere, as a joint turns only the axes behind it.
inline void SubtractWrenchStiffness(const ChainPoses<double>& poses,
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

#endif  // FINRAY_CHAIN_ELASTIC_CHAIN_H_
