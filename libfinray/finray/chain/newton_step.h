#ifndef FINRAY_CHAIN_NEWTON_STEP_H_
#define FINRAY_CHAIN_NEWTON_STEP_H_

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

namespace finray {

/// The largest turn of any link that changes `step` of the joint angles make:
/// their partial sums, rad.
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

#endif  // FINRAY_CHAIN_NEWTON_STEP_H_
