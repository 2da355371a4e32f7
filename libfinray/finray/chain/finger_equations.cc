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

}  // namespace

Eigen::MatrixXd FingerJacobian(const ChainLayout& layout, const double* theta,
                               const double* loads, const double* contact,
                               double friction) {
  const int n = layout.joints();
  const int r = static_cast<int>(layout.ribs.size());
  const ChainPoses<double> poses = Kinematics(layout.chain, theta);
  Eigen::MatrixXd jacobian = Eigen::MatrixXd::Zero(n + 3 + r, n + 3 + r + 2);
  jacobian.topLeftCorner(3, n) =
      TipDeviationJacobian(layout.chain, poses, layout.target);
  // K - K_J and -J_t^T.
  auto torque_by_theta = jacobian.block(3, 0, n, n);
  torque_by_theta.diagonal() = layout.chain.stiffness;
  SubtractWrenchStiffness(
      poses, WrenchesBeyond(layout, poses, loads, contact, friction),
      torque_by_theta);
  jacobian.block(3, n, n, 3) = -poses.xi.transpose();

  for (int k = 0; k < r; ++k) {
    const ChainRib& rib = layout.ribs[k];
    const RibFrame<double> frame = MakeRibFrame(rib, poses);
    const RibMotion motion = MakeRibMotion(rib, frame, poses);
    const int first = rib.joints_before_left;
    const int count = rib.joints_before_right - first;
    // J_L - J_R is -xi between L and R and 0 elsewhere.
    const auto xi = poses.xi.middleCols(first, count);
    torque_by_theta.middleRows(first, count).noalias() +=
        loads[3 + k] * xi.transpose() * RibWrenchJacobian(frame, motion);
    jacobian.col(n + 3 + k).segment(3 + first, count) =
        xi.transpose() * frame.wrench;
    jacobian.row(3 + n + k).head(n) =
        frame.direction.transpose() * motion.across;
    jacobian(3 + n + k, n + 3 + k) = rib.compliance_mm_per_N;
  }

  const ContactFrame<double> frame =
      MakeContactFrame(layout, poses, contact[0], friction);
  const int n_c = frame.joints_before;
  const auto xi_c = poses.xi.leftCols(n_c);
  torque_by_theta.topLeftCorner(n_c, n_c).noalias() -=
      contact[1] * xi_c.transpose() * ContactWrenchJacobian(frame, poses);
  // (28): the point moves along y_c and the direction stays.
  const Wrench<double> by_arc(Cross(frame.tangent, frame.force), 0, 0);
  jacobian.col(n + 3 + r).segment(3, n_c) =
      -contact[1] * xi_c.transpose() * by_arc;
  jacobian.col(n + 4 + r).segment(3, n_c) = -xi_c.transpose() * frame.wrench;
  return jacobian;
}

Eigen::VectorXd ScaledEquations::ColumnUnits() const {
  const int n = layout.joints(), r = layout.loads() - 3;
  const double length = layout.length_unit_mm, force = layout.force_unit_N;
  Eigen::VectorXd units(n + 3 + r + 2);
  units << Eigen::VectorXd::Ones(n), force * length, force, force,
      Eigen::VectorXd::Constant(r, force), length, force;
  return units;
}

Eigen::VectorXd ScaledEquations::ModelWeights() const {
  const int n = layout.joints(), r = layout.loads() - 3;
  const double length = layout.length_unit_mm;
  Eigen::VectorXd units(n + 3 + r);
  units << 1, length, length,
      Eigen::VectorXd::Constant(n, layout.force_unit_N * length),
      Eigen::VectorXd::Constant(r, length);
  return model_weight * units.cwiseInverse();
}

Eigen::VectorXd ScaledEquations::Residual(const double* theta,
                                          const double* loads,
                                          const double* contact) const {
  Eigen::VectorXd c(rows());
  c.head(layout.joints() + layout.loads()) =
      FingerEquations<double>(layout, theta, loads, contact, friction)
          .cwiseProduct(ModelWeights());
  if (s0.size() > 0) {
    const Eigen::Map<const Eigen::VectorXd> angles(theta, layout.joints());
    c.tail(s0.size()) = (layout.gauges * angles - s0) / gauge_std_rad;
  }
  return c;
}

Eigen::MatrixXd ScaledEquations::Jacobian(const double* theta,
                                          const double* loads,
                                          const double* contact) const {
  const Eigen::MatrixXd model =
      FingerJacobian(layout, theta, loads, contact, friction);
  Eigen::MatrixXd jacobian = Eigen::MatrixXd::Zero(rows(), model.cols());
  jacobian.topRows(model.rows()) = ModelWeights().asDiagonal() * model;
  if (s0.size() > 0) {
    jacobian.bottomLeftCorner(s0.size(), layout.joints()) =
        layout.gauges / gauge_std_rad;
  }
  return jacobian;
}

ChainCost::ChainCost(const ScaledEquations& equations) : equations_(equations) {
  set_num_residuals(equations.rows());
  *mutable_parameter_block_sizes() = {equations.layout.joints(),
                                      equations.layout.loads(), 2};
}

bool ChainCost::Evaluate(double const* const* x, double* residuals,
                         double** jacobians) const {
  Eigen::Map<Eigen::VectorXd> c(residuals, num_residuals());
  c = equations_.Residual(x[0], x[1], x[2]);
  if (jacobians == nullptr) return c.allFinite();
  const Eigen::MatrixXd all = equations_.Jacobian(x[0], x[1], x[2]);
  int first = 0;
  for (int b = 0; b < 3; ++b) {
    const int size = parameter_block_sizes()[b];
    if (jacobians[b] != nullptr) {
      Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic,
                               Eigen::RowMajor>>(
          jacobians[b], num_residuals(), size) = all.middleCols(first, size);
    }
    first += size;
  }
  return c.allFinite();
}

ceres::Solver::Options ChainSolverOptions(
    ceres::LinearSolverType linear_solver) {
  ceres::Solver::Options options;
  options.linear_solver_type = linear_solver;
  // The default radius damps away the gauge rows, which are light beside the
  // model's.
  options.initial_trust_region_radius = 1e12;
  options.max_trust_region_radius = 1e16;
  options.function_tolerance = 1e-16;
  options.logging_type = ceres::SILENT;
  return options;
}

}  // namespace finray
