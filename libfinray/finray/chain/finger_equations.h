#ifndef FINRAY_CHAIN_FINGER_EQUATIONS_H_
#define FINRAY_CHAIN_FINGER_EQUATIONS_H_

#include <ceres/cost_function.h>
#include <ceres/solver.h>

#include <Eigen/Core>

#include "finray/chain/chain_layout.h"

namespace finray {

// Equations (7) to (12), (14), (15) and (25) of the paper: the finger under one
// contact (Sections III and IV.A). Unknowns:
//
//   theta            n joint angles, rad
//   loads = (F_t, f) 3 + r: the wrench on the chain at {T} in N mm and N, then
//                    the rib forces in N, compression > 0 as in (8), so that a
//                    rib's tension is -f_k
//   contact          (l_c, f_c), mm and N
//
// Equations C(theta, F_t, f) of (12):
//
//   y   = ln(g_st g_t^-1)^vee                                       (4)
//   tau = K theta - J_t^T F_t - sum (J_Lk - J_Rk)^T F_k - J_c^T F_c   (9), (14)
//   d_k = |r_Lk - r_Rk| - d_k0 (1 - f_k / EA_k)                     (7)
//
// with F_k = f_k W_k (8) and F_c = f_c W_c (15). Friction is added to the
// paper's contact: W_c is the wrench of x_c + mu y_c. The contact frame belongs
// to the link that holds l_c: n_c counts the front joints before l_c, and x_c
// turns by theta_i where l_c passes joint i. f_c = 0 means no contact.

/// A rib in one configuration.
template <typename T>
struct RibFrame {
  Vector2<T> left, right;  ///< r_L and r_R of (11).
  T distance;
  Vector2<T> direction;  ///< u_k, from R to L.
  Wrench<T> wrench;      ///< W_k.
};

template <typename T>
RibFrame<T> MakeRibFrame(const ChainRib& rib, const ChainPoses<T>& poses) {
  RibFrame<T> frame;
  frame.left =
      poses.after[rib.joints_before_left] * Vector2<T>(rib.left.cast<T>());
  frame.right =
      poses.after[rib.joints_before_right] * Vector2<T>(rib.right.cast<T>());
  const Vector2<T> across = frame.left - frame.right;
  frame.distance = across.norm();
  frame.direction = across / frame.distance;
  frame.wrench = ForceWrench(frame.left, frame.direction);
  return frame;
}

/// The contact frame {C} in one configuration.
template <typename T>
struct ContactFrame {
  int joints_before = 0;       ///< n_c.
  Vector2<T> point;            ///< r_C.
  Vector2<T> normal, tangent;  ///< x_c and y_c.
  Vector2<T> force;            ///< x_c + mu y_c: the force per unit of f_c.
  Wrench<T> wrench;            ///< W_c.
};

/// g_sc of (25) and W_c of (15). `arc` is l_c, on the front beam.
template <typename T>
ContactFrame<T> MakeContactFrame(const ChainLayout& layout,
                                 const ChainPoses<T>& poses, const T& arc,
                                 double friction) {
  ContactFrame<T> frame;
  for (const double joint : layout.front_joint_mm) {
    if (arc > T(joint)) ++frame.joints_before;
  }
  const Pose<T>& g = poses.after[frame.joints_before];
  frame.point = g * Vector2<T>(T(0), arc);
  frame.normal = g.Rotate(Vector2<T>(T(1), T(0)));
  frame.tangent = g.Rotate(Vector2<T>(T(0), T(1)));
  frame.force = frame.normal + T(friction) * frame.tangent;
  frame.wrench = ForceWrench(frame.point, frame.force);
  return frame;
}

/// The sum of the wrenches that act beyond each joint, 3 x n. J^T F of (14) is
/// xi_i . (column i). The two wrenches of a rib cancel beyond R.
template <typename T>
Eigen::Matrix<T, 3, Eigen::Dynamic> WrenchesBeyond(const ChainLayout& layout,
                                                   const ChainPoses<T>& poses,
                                                   const T* loads,
                                                   const T* contact,
                                                   double friction) {
  const int n = layout.joints();
  Eigen::Matrix<T, 3, Eigen::Dynamic> beyond(3, n);
  beyond.colwise() = Wrench<T>(loads[0], loads[1], loads[2]);
  for (std::size_t k = 0; k < layout.ribs.size(); ++k) {
    const ChainRib& rib = layout.ribs[k];
    const Wrench<T> wrench = MakeRibFrame(rib, poses).wrench * loads[3 + k];
    for (int i = rib.joints_before_left; i < rib.joints_before_right; ++i) {
      beyond.col(i) -= wrench;
    }
  }
  const ContactFrame<T> frame =
      MakeContactFrame(layout, poses, contact[0], friction);
  const Wrench<T> wrench = frame.wrench * contact[1];
  for (int i = 0; i < frame.joints_before; ++i) beyond.col(i) += wrench;
  return beyond;
}

/// C of (12): y (3), tau (n entries in N mm), d (r entries in mm).
template <typename T>
Eigen::Matrix<T, Eigen::Dynamic, 1> FingerEquations(const ChainLayout& layout,
                                                    const T* theta,
                                                    const T* loads,
                                                    const T* contact,
                                                    double friction) {
  const ChainPoses<T> poses = Kinematics(layout.chain, theta);
  const int n = layout.joints();
  Eigen::Matrix<T, Eigen::Dynamic, 1> c(n + layout.loads());
  c.template head<3>() = TipDeviation(layout.chain, poses, layout.target);
  const auto beyond = WrenchesBeyond(layout, poses, loads, contact, friction);
  for (int i = 0; i < n; ++i) {
    c[3 + i] = layout.chain.stiffness[i] * theta[i] -
               poses.xi.col(i).dot(beyond.col(i));
  }
  for (std::size_t k = 0; k < layout.ribs.size(); ++k) {
    const ChainRib& rib = layout.ribs[k];
    c[3 + n + k] = MakeRibFrame(rib, poses).distance - rib.length_mm +
                   rib.compliance_mm_per_N * loads[3 + k];
  }
  return c;
}

/// The Jacobian of FingerEquations by (theta, loads, contact),
/// (n + 3 + r) x (n + 3 + r + 2). Without its last two columns it is (13); its
/// rows of tau are (22), (23) and (26) to (28), its rows of d those of (21).
/// S_e of (24) is ChainLayout::gauges. The derivative by l_c is the one on the
/// link that holds l_c.
Eigen::MatrixXd FingerJacobian(const ChainLayout& layout, const double* theta,
                               const double* loads, const double* contact,
                               double friction);

/// C(theta, F_t, f, l_c, f_c) of (17) with scaled rows:
///
///   w (y, tau, d) / (their units)   n + 3 + r rows of the model;
///   (S_e theta - s_0) / sigma       m rows of the gauges, (16).
///
/// Without gauges and with w = 1 these are the rows of (12). The units make
/// rows and columns comparable whatever the size and stiffness of the finger:
/// lengths in l_0, forces in F_0 = ForceUnit(), moments in F_0 l_0 (the moment
/// that bends a beam by about a radian), angles in rad.
struct ScaledEquations {
  const ChainLayout& layout;  ///< Must outlive this.
  double friction = 0;
  double model_weight = 1;   ///< w.
  Eigen::VectorXd s0 = {};   ///< m gauge angles in rad, or none.
  double gauge_std_rad = 1;  ///< sigma.

  int rows() const {
    return layout.joints() + layout.loads() + static_cast<int>(s0.size());
  }
  /// Units of the columns (theta, F_t, f, l_c, f_c): n + 3 + r + 2.
  Eigen::VectorXd ColumnUnits() const;

  /// `contact` holds (l_c, f_c) in mm and N.
  Eigen::VectorXd Residual(const double* theta, const double* loads,
                           const double* contact) const;
  /// Derivatives of Residual by (theta, F_t, f, l_c, f_c) in rad, N mm, N and
  /// mm, rows() x (n + 3 + r + 2).
  Eigen::MatrixXd Jacobian(const double* theta, const double* loads,
                           const double* contact) const;

 private:
  Eigen::VectorXd ModelWeights() const;
};

/// The rows of ScaledEquations as one residual block over the parameter blocks
/// theta (n), (F_t, f) (3 + r) and (l_c, f_c) (2).
class ChainCost : public ceres::CostFunction {
 public:
  explicit ChainCost(const ScaledEquations& equations);

  /// Fails for values that are not finite, so that Ceres takes a smaller step.
  bool Evaluate(double const* const* x, double* residuals,
                double** jacobians) const override;

 private:
  const ScaledEquations equations_;
};

/// Options for a problem with such a block.
ceres::Solver::Options ChainSolverOptions(
    ceres::LinearSolverType linear_solver);

}  // namespace finray

#endif  // FINRAY_CHAIN_FINGER_EQUATIONS_H_
