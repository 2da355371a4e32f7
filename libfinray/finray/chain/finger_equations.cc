#include "finray/chain/finger_equations.h"

namespace finray {
namespace {

// d r_L and d (r_L - r_R) by theta, 2 x n each: Gamma_L J_L and
// Gamma_L J_L - Gamma_R J_R of (21).
struct RibMotion {
  Eigen::Matrix2Xd left, across;
};

RibMotion MakeRibMotion(const ChainRib& rib, const RibFrame<double>& frame,
                        const ChainPoses<double>& poses) {
  RibMotion motion;
  motion.left.setZero(2, poses.xi.cols());
  motion.across.setZero(2, poses.xi.cols());
  for (int j = 0; j < rib.joints_before_right; ++j) {
    const Twist<double> xi = poses.xi.col(j);
    if (j < rib.joints_before_left) {
      motion.left.col(j) = Velocity<double>(xi, frame.left);
    }
    motion.across.col(j) =
        motion.left.col(j) - Velocity<double>(xi, frame.right);
  }
  return motion;
}

// d W_k / d theta of (23), 3 x n: the line of the force turns with the rib.
Eigen::Matrix3Xd RibWrenchJacobian(const RibFrame<double>& frame,
                                   const RibMotion& motion) {
  const Eigen::Vector2d& u = frame.direction;
  const Eigen::Matrix2Xd du =
      (Eigen::Matrix2d::Identity() - u * u.transpose()) * motion.across /
      frame.distance;
  Eigen::Matrix3Xd jacobian(3, du.cols());
  for (Eigen::Index j = 0; j < du.cols(); ++j) {
    jacobian.col(j) << Cross(frame.left, du.col(j)) +
                           Cross(motion.left.col(j), u),
        du.col(j);
  }
  return jacobian;
}

// d W_c / d theta of (27) for the n_c joints before {C}, 3 x n_c: Gamma_C J_c
// moves the point and Psi J_c turns the force.
Eigen::Matrix3Xd ContactWrenchJacobian(const ContactFrame<double>& frame,
                                       const ChainPoses<double>& poses) {
  Eigen::Matrix3Xd jacobian(3, frame.joints_before);
  for (int j = 0; j < frame.joints_before; ++j) {
    const Twist<double> xi = poses.xi.col(j);
    const Eigen::Vector2d moved = Velocity<double>(xi, frame.point);
    const Eigen::Vector2d turned = xi[0] * Turned<double>(frame.force);
    jacobian.col(j) << Cross(frame.point, turned) + Cross(moved, frame.force),
        turned;
  }
  return jacobian;
}

// d d / d theta of (21), r x n.
Eigen::MatrixXd RibJacobian(const ChainLayout& layout,
                            const ChainPoses<double>& poses) {
  Eigen::MatrixXd jacobian(layout.ribs.size(), layout.joints());
  for (std::size_t k = 0; k < layout.ribs.size(); ++k) {
    const RibFrame<double> frame = MakeRibFrame(layout.ribs[k], poses);
    jacobian.row(k) = frame.direction.transpose() *
                      MakeRibMotion(layout.ribs[k], frame, poses).across;
  }
  return jacobian;
}

}  // namespace

TorqueJacobian MakeTorqueJacobian(const ChainLayout& layout,
                                  const ChainPoses<double>& poses,
                                  const double* loads, const double* contact,
                                  double friction) {
  const int n = layout.joints();
  TorqueJacobian jacobian;
  jacobian.theta = layout.chain.stiffness.asDiagonal();
  SubtractWrenchStiffness(
      poses, WrenchesBeyond(layout, poses, loads, contact, friction),
      jacobian.theta);
  jacobian.loads.setZero(n, layout.loads());
  jacobian.loads.leftCols<3>() = -poses.xi.transpose();

  for (std::size_t k = 0; k < layout.ribs.size(); ++k) {
    const ChainRib& rib = layout.ribs[k];
    const RibFrame<double> frame = MakeRibFrame(rib, poses);
    const RibMotion motion = MakeRibMotion(rib, frame, poses);
    const int first = rib.joints_before_left;
    const int count = rib.joints_before_right - first;
    // J_L - J_R is -xi between L and R and 0 elsewhere.
    const auto xi = poses.xi.middleCols(first, count);
    jacobian.theta.middleRows(first, count).noalias() +=
        loads[3 + k] * xi.transpose() * RibWrenchJacobian(frame, motion);
    jacobian.loads.col(3 + k).segment(first, count) =
        xi.transpose() * frame.wrench;
  }

  const ContactFrame<double> frame =
      MakeContactFrame(layout, poses, contact[0], friction);
  const int n_c = frame.joints_before;
  const auto xi_c = poses.xi.leftCols(n_c);
  jacobian.theta.topLeftCorner(n_c, n_c).noalias() -=
      contact[1] * xi_c.transpose() * ContactWrenchJacobian(frame, poses);
  jacobian.contact.setZero(n, 2);
  // (28): the point moves along y_c and the direction stays.
  const Wrench<double> by_arc(Cross(frame.tangent, frame.force), 0, 0);
  jacobian.contact.col(0).head(n_c) = -contact[1] * xi_c.transpose() * by_arc;
  jacobian.contact.col(1).head(n_c) = -xi_c.transpose() * frame.wrench;
  return jacobian;
}

Eigen::MatrixXd FingerJacobian(const ChainLayout& layout, const double* theta,
                               const double* loads, const double* contact,
                               double friction) {
  const int n = layout.joints();
  const int r = static_cast<int>(layout.ribs.size());
  const ChainPoses<double> poses = Kinematics(layout.chain, theta);
  const TorqueJacobian torque =
      MakeTorqueJacobian(layout, poses, loads, contact, friction);
  Eigen::MatrixXd jacobian = Eigen::MatrixXd::Zero(n + 3 + r, n + 3 + r + 2);
  jacobian.topLeftCorner(3, n) =
      TipDeviationJacobian(layout.chain, poses, layout.target);
  jacobian.middleRows(3, n) << torque.theta, torque.loads, torque.contact;
  jacobian.bottomLeftCorner(r, n) = RibJacobian(layout, poses);
  for (int k = 0; k < r; ++k) {
    jacobian(3 + n + k, n + 3 + k) = layout.ribs[k].compliance_mm_per_N;
  }
  return jacobian;
}

}  // namespace finray
