#ifndef FINRAY_CHAIN_CERES_FORWARD_H_
#define FINRAY_CHAIN_CERES_FORWARD_H_

#include <ceres/types.h>

#include "finray/chain/chain_state.h"

namespace finray {

/// ContinueForward with ceres::Solve in place of Newton (6): the residual
/// blocks of chain_cost.h without gauges, the contact held, from wherever
/// `state` is. As many equations as unknowns, so the weight does not matter and
/// the cost falls to rounding. False if it does not get there; `state` is then
/// unchanged. Tells the iterations it took if `iterations` is given.
bool ContinueForwardWithCeres(const ChainLayout& layout,
                              const ChainContact& contact,
                              ceres::LinearSolverType linear_solver,
                              ChainState* state, int* iterations = nullptr);

}  // namespace finray

#endif  // FINRAY_CHAIN_CERES_FORWARD_H_
