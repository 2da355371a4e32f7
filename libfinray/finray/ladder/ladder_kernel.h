#ifndef FINRAY_LADDER_LADDER_KERNEL_H_
#define FINRAY_LADDER_LADDER_KERNEL_H_

#include "finray/finger/discretization.h"
#include "finray/ladder/ladder_frame.h"
#include "finray/ladder/lanes.h"

namespace finray {

// One Newton step of the lifted ladder (ladder.h) in two passes.
//
// Evaluate: every element starts from its stored state, so all of them are
// integrated side by side in vector lanes. Internal forces follow from base
// forces, rib tensions and stored hinge positions.
//
// Sweep: both beams are walked from base to tip. The changes of the state of
// both, twelve numbers, lie in an affine space of six parameters, at first the
// base moments and forces:
//
//   dz = B p + b,   B 12 x 6.
//
// An element multiplies by its map and adds its gap to b. A rib of length L and
// tension T is an equation g . p + g_0 = kappa dT, kappa = L / EA, which takes
// one parameter away as dT becomes one. So there are six throughout, whatever
// the number of ribs, and the cost is linear in elements. The only operation is
// the exchange of a parameter p_k, with the largest |g_k|, for another quantity
// tau:
//
//   p_k = (kappa tau - sum_{j != k} g_j p_j - g_0) / g_k.
//
// Where B grows too far (long, soft, highly loaded bays grow like exp(sqrt(N
// L^2 / EI))) the parameters are exchanged for entries of dz with full
// pivoting, which keeps the sweep as stable as Gaussian elimination with
// pivoting. At the tip six exchanges with kappa = 0 use up the parameters.
// Walking back through the exchanges gives the step.

struct LadderKernel {
  /// Fills slots, maps, readouts, gaps and closures, for a sweep with such
  /// columns or with none. With `propagate` the nodes are overwritten by what
  /// reaches them, so that there are no gaps.
  void (*evaluate)(LadderFrame<double>&, SweepColumns, bool propagate);
  /// Solves for taps, q_step and, but for kContacts, the step. False if the
  /// system is singular.
  bool (*sweep)(LadderFrame<double>&, SweepColumns, bool readouts);
  /// After a sweep with kContacts, which takes up to kFittedContacts: the step
  /// of the frame's `newton` times Newton's that also moves the contacts, by
  /// the frame's `change` in the caller's order.
  void (*combine)(LadderFrame<double>&);
  /// Fills taps only, with all of q as parameters: no rib is exchanged and the
  /// tip stays open.
  void (*open_sweep)(LadderFrame<double>&, SweepColumns);

  /// The same for four frames in lanes, with the derivatives by one contact; a
  /// sweep is singular if it is in any lane. Its memory is that of SetColumns
  /// with kContacts and one contact.
  struct {
    void (*evaluate)(LadderFrame<FourFrames>&);
    bool (*sweep)(LadderFrame<FourFrames>&);
    /// What combine leaves in `step` is also added to the state.
    void (*step)(LadderFrame<FourFrames>&);
  } four;
};

/// The kernel of a scheme in the best instruction set of this machine; kStretch
/// for beams with axial flexibility.
const LadderKernel& FindLadderKernel(Scheme scheme, bool stretch);

/// The instruction sets that this machine can run, best first, and the kernel
/// of one of them: for tests and benchmarks.
int LadderInstructionSets();
const char* LadderInstructionSetName(int set);
const LadderKernel& FindLadderKernel(Scheme scheme, bool stretch, int set);

}  // namespace finray

#endif  // FINRAY_LADDER_LADDER_KERNEL_H_
