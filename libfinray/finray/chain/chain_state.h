#ifndef FINRAY_CHAIN_CHAIN_STATE_H_
#define FINRAY_CHAIN_CHAIN_STATE_H_

#include <Eigen/Core>

#include "finray/chain/chain_layout.h"

namespace finray {

/// A contact on the front beam: f_c along x_c, into the finger, and
/// friction * f_c along y_c, towards the tip.
struct ChainContact {
  double arc_mm = 0;    ///< l_c.
  double normal_N = 0;  ///< f_c.
  double friction = 0;  ///< mu; the paper has none.
};

/// The unknowns of C(theta, F_t, f).
struct ChainState {
  Eigen::VectorXd theta;  ///< n joint angles, rad.
  Eigen::VectorXd loads;  ///< (F_t, f): m, f_x, f_y, then r rib compressions.

  /// The straight, unloaded finger.
  static ChainState Straight(const ChainLayout& layout);

  double rib_tension(int rib) const { return -loads[3 + rib]; }
  bool AllFinite() const { return theta.allFinite() && loads.allFinite(); }
};

/// Units that make rows and columns of a finger comparable whatever its size
/// and stiffness: lengths in l_0, forces in F_0 = ForceUnit(), moments in
/// F_0 l_0 (the moment that bends a beam by about a radian), angles in rad.
struct ChainUnits {
  Eigen::VectorXd rows;     ///< of (y, tau, d): n + 3 + r.
  Eigen::VectorXd columns;  ///< of (theta, F_t, f, l_c, f_c): n + 3 + r + 2.

  explicit ChainUnits(const ChainLayout& layout);
};

}  // namespace finray

#endif  // FINRAY_CHAIN_CHAIN_STATE_H_
