#ifndef FINRAY_CHAIN_FORWARD_H_
#define FINRAY_CHAIN_FORWARD_H_

#include "finray/chain/chain_state.h"

namespace finray {

/// Finds C(theta, F_t, f) = 0 of (12) with (14) for a given contact: Newton (6)
/// with the analytic Jacobian (13) and a dense LU of order n + 3 + r, started
/// from the straight finger; if that fails, along a ramp of the force and of
/// the assembly prestress together. Steps are shortened to turn no link by more
/// than half a radian.
///
/// False if no equilibrium was found or if the contact is off the beam or not
/// finite; `state` is then the straight finger. It never holds a NaN.
bool SolveForward(const ChainLayout& layout, const ChainContact& contact,
                  ChainState* state);

}  // namespace finray

#endif  // FINRAY_CHAIN_FORWARD_H_
