// Compiled once for every instruction set; see CMakeLists.txt.
#include "finray/ladder/ladder_kernel.h"

#include "finray/ladder/ladder_evaluate.h"
#include "finray/ladder/ladder_sweep.h"
#include "finray/ladder/rigid_link_element.h"
#include "finray/ladder/taylor_element.h"

namespace finray {
inline namespace FINRAY_ISA {
namespace {

using Frame = LadderFrame<double>;
using V = Lanes<double>::Vector;

template <class Wide, class Single>
void EvaluateScheme(Frame& frame, SweepColumns columns, bool propagate) {
  LadderEvaluator<double, Wide, Single>(&frame, columns).Evaluate(propagate);
}

bool SweepColumnsOf(Frame& frame, SweepColumns columns, bool open,
                    bool readouts) {
  // Fixed lengths for the common cases: a step, and up to one contact's
  // derivatives.
  constexpr int kWidth = Lanes<double>::kWidth;
  switch (frame.stride) {
    case 8:
      return LadderSweeper<double, 8 / kWidth>(&frame, columns, open)
          .Run(readouts);
    case 12:
      if constexpr (12 % kWidth == 0) {
        return LadderSweeper<double, 12 / kWidth>(&frame, columns, open)
            .Run(readouts);
      }
      break;
    case 16:
      return LadderSweeper<double, 16 / kWidth>(&frame, columns, open)
          .Run(readouts);
  }
  return LadderSweeper<double, 0>(&frame, columns, open).Run(readouts);
}

bool Sweep(Frame& frame, SweepColumns columns, bool readouts) {
  return SweepColumnsOf(frame, columns, false, readouts);
}

void Combine(Frame& frame) {
  LadderWalkBack<double, 0>(&frame, SweepColumns::kContacts).Combine();
}

void OpenSweep(Frame& frame, SweepColumns columns) {
  SweepColumnsOf(frame, columns, true, true);
}

template <class Wide, class Single>
constexpr LadderKernel KernelOfScheme() {
  return {EvaluateScheme<Wide, Single>, Sweep, Combine, OpenSweep};
}

template <int K, bool kStretch>
constexpr LadderKernel TaylorKernel() {
  return KernelOfScheme<TaylorElement<K, V, kStretch>,
                        TaylorElement<K, double, kStretch>>();
}

}  // namespace

const LadderKernel& KernelOf(Scheme scheme, bool stretch) {
  static constexpr LadderKernel kernels[][2] = {
      {KernelOfScheme<RigidLinkElement<V>, RigidLinkElement<double>>(),
       KernelOfScheme<RigidLinkElement<V>, RigidLinkElement<double>>()},
      {TaylorKernel<4, false>(), TaylorKernel<4, true>()},
      {TaylorKernel<8, false>(), TaylorKernel<8, true>()},
      {TaylorKernel<12, false>(), TaylorKernel<12, true>()},
      {TaylorKernel<16, false>(), TaylorKernel<16, true>()}};
  return kernels[static_cast<int>(scheme)][stretch];
}

}  // namespace FINRAY_ISA
}  // namespace finray
