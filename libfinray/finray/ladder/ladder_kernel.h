#ifndef FINRAY_LADDER_LADDER_KERNEL_H_
#define FINRAY_LADDER_LADDER_KERNEL_H_

#include "finray/finger/discretization.h"
#include "finray/ladder/ladder_frame.h"

namespace finray {

// One Newton step of the ladder (ladder.h) in two passes.
//
// Evaluate: every element starts from its stored state, so vector lanes
// integrate several elements side by side. Internal forces follow from base
// forces, rib tensions and stored hinge positions.
//
// Sweep: both beams are walked from base to tip. The changes dz of the states
// of both, twelve numbers, are an affine function of six parameters p, at first
// the base moments and forces:
//
//   dz = B p + b,   B 12 x 6.
//
// An element multiplies B and b by its map and adds its gap to b. A rib of
// length L and tension T is an equation g . p + g_0 = kappa dT, kappa = L / EA,
// which removes one parameter while dT becomes one. So there are always six,
// and the cost is linear in the number of elements. The only operation
// exchanges the parameter p_k with the largest |g_k| for another quantity tau:
//
//   p_k = (kappa tau - sum_{j != k} g_j p_j - g_0) / g_k.
//
// B grows like exp(sqrt(N L^2 / EI)) over long, soft, heavily loaded bays. If
// it grows too far, the parameters are exchanged for entries of dz with full
// pivoting, which makes the sweep as stable as Gaussian elimination with
// pivoting. At the tip six exchanges with kappa = 0 use up the parameters. The
// walk back through the exchanges gives the step.

struct LadderKernel {
  /// Fills slots, maps, readouts, gaps and closures for a sweep with `columns`
  /// or with kNone. With `propagate` each node is overwritten by the end of the
  /// element before it, so that there are no gaps.
  void (*evaluate)(LadderFrame<double>&, SweepColumns, bool propagate);
  /// Solves for taps, q_step and, except for kContacts, the step. False if the
  /// system is singular.
  bool (*sweep)(LadderFrame<double>&, SweepColumns, bool readouts);
  /// After a sweep with kContacts, for up to kFittedContacts: fills `step` with
  /// the frame's `newton` times Newton's step, contacts being moved by the
  /// frame's `change` in the caller's order.
  void (*combine)(LadderFrame<double>&);
  /// Fills the taps only, with all of q as parameters: no rib is exchanged and
  /// the tip stays open.
  void (*open_sweep)(LadderFrame<double>&, SweepColumns);
};

/// The kernel of a scheme in the best instruction set of this machine.
/// `stretch` is for beams with axial flexibility.
const LadderKernel& FindLadderKernel(Scheme scheme, bool stretch);

/// For tests and benchmarks: the kernel of one of InstructionSets().
const LadderKernel& FindLadderKernel(Scheme scheme, bool stretch, int set);

}  // namespace finray

#endif  // FINRAY_LADDER_LADDER_KERNEL_H_
