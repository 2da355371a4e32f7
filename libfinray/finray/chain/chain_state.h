#ifndef FINRAY_CHAIN_CHAIN_STATE_H_
#define FINRAY_CHAIN_CHAIN_STATE_H_

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "finray/chain/chain_layout.h"

namespace finray {

/// The unknowns of C(theta, F_t, f), equation (12).
struct ChainState {
  Eigen::VectorXd theta;  ///< n joint angles, rad.
  Eigen::VectorXd loads;  ///< (F_t, f): m, f_x, f_y, then r rib compressions.

  /// The straight, unloaded finger.
  static ChainState Straight(const ChainLayout& layout) {
    return {Eigen::VectorXd::Zero(layout.joints()),
            Eigen::VectorXd::Zero(layout.loads())};
  }

  double rib_tension(int rib) const { return -loads[3 + rib]; }
  bool AllFinite() const { return theta.allFinite() && loads.allFinite(); }
};

/// The largest turn of any link, in rad, that changes `step` of the joint
/// angles cause: the largest of their partial sums.
template <typename Derived>
double LargestTurn(const Eigen::MatrixBase<Derived>& step) {
  double turn = 0, largest = 0;
  for (Eigen::Index i = 0; i < step.size(); ++i) {
    turn += step[i];
    largest = std::max(largest, std::abs(turn));
  }
  return largest;
}

}  // namespace finray

#endif  // FINRAY_CHAIN_CHAIN_STATE_H_
