#ifndef FINRAY_CHAIN_SCALED_EQUATIONS_H_
#define FINRAY_CHAIN_SCALED_EQUATIONS_H_

#include <Eigen/Core>

#include "finray/chain/chain_layout.h"

namespace finray {

/// C(theta, F_t, f, l_c, f_c) of (17) with scaled rows:
///
///   w (y, tau, d) / (their units)   n + 3 + r rows of the model,
///                                   see finger_equations.h;
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

}  // namespace finray

#endif  // FINRAY_CHAIN_SCALED_EQUATIONS_H_
