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

/// The same from wherever `state` is, as along a log: Newton only, until a step
/// (in the units of ChainUnits) is below `last_step`, after which the error is
/// of the order of its square. False if that fails; `state` is then unchanged.
/// Tells the steps it took if `iterations` is given.
bool ContinueForward(const ChainLayout& layout, const ChainContact& contact,
                     double last_step, ChainState* state,
                     int* iterations = nullptr);

}  // namespace finray

#endif  // FINRAY_CHAIN_FORWARD_H_
