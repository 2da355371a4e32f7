#ifndef FINRAY_CHAIN_FORWARD_H_
#define FINRAY_CHAIN_FORWARD_H_

#include <ceres/types.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "finray/chain/chain_layout.h"
#include "finray/finger/point_contact.h"

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

/// Solves C(theta, F_t, f) = 0 of (12) with (14) for a given contact on the
/// front beam: Newton (6) with the analytic Jacobian (13) and a dense LU of
/// order n + 3 + r, from the straight finger. If that fails, the contact force
/// and the assembly prestress grow along a ramp together. Steps are shortened
/// so that no link turns by more than half a radian.
///
/// False if no equilibrium was found or if the contact is off the beam or not
/// finite; `state` is then the straight finger. It never holds a NaN.
bool SolveForward(const ChainLayout& layout, const PointContact& contact,
                  ChainState* state);

/// The same from the present `state`, as along a log, and by Newton only. It
/// ends when a step in the units of ScaledEquations is below `last_step`; the
/// error left is of the order of the square of that. Returns false and leaves
/// `state` unchanged if it fails. Sets `iterations` if it is given.
bool ContinueForward(const ChainLayout& layout, const PointContact& contact,
                     double last_step, ChainState* state,
                     int* iterations = nullptr);

/// ContinueForward with ceres::Solve in place of Newton (6). There
/// are as many equations as unknowns, so the cost falls to rounding. Returns
/// false and leaves `state` unchanged if it does not. Sets `iterations` if it
/// is given.
bool ContinueForwardWithCeres(const ChainLayout& layout,
                              const PointContact& contact,
                              ceres::LinearSolverType linear_solver,
                              ChainState* state, int* iterations = nullptr);

}  // namespace finray

#endif  // FINRAY_CHAIN_FORWARD_H_
