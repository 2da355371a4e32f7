// Compiled once for every instruction set; see CMakeLists.txt.
#include "finray/statics/ladder_kernel.h"

#include "finray/statics/ladder_evaluate.h"
#include "finray/statics/ladder_sweep.h"
#include "finray/statics/rigid_link_element.h"
#include "finray/statics/taylor_element.h"

namespace finray {
inline namespace FINRAY_ISA {
namespace {

using Frame = LadderFrame<double>;
using V = Lanes<double>::Vector;

template <class Wide, class Single>
double EvaluateScheme(Frame& frame, bool parameters, bool propagate) {
  return LadderEvaluator<double, Wide, Single>(&frame).Evaluate(parameters,
                                                                propagate);
}

template <class Wide, class Single>
void ReadGaugesOfScheme(Frame& frame) {
  LadderEvaluator<double, Wide, Single>(&frame).ReadGauges();
}

bool SweepColumnsOf(Frame& frame, SweepColumns columns, bool open,
                    bool readouts) {
  // The lengths that a step and one contact's derivatives need.
  switch (frame.stride) {
    case 8:
      return LadderSweeper<double, 2>(&frame, columns, open).Run(readouts);
    case 12:
      return LadderSweeper<double, 3>(&frame, columns, open).Run(readouts);
    case 16:
      return LadderSweeper<double, 4>(&frame, columns, open).Run(readouts);
    default:
      return LadderSweeper<double, 0>(&frame, columns, open).Run(readouts);
  }
}

bool Sweep(Frame& frame, SweepColumns columns, bool readouts) {
  return SweepColumnsOf(frame, columns, false, readouts);
}

void Combine(Frame& frame, const double* change) {
  LadderSweeper<double, 0>(&frame, SweepColumns::kContacts, false)
      .Combine(change);
}

void OpenSweep(Frame& frame, SweepColumns columns) {
  SweepColumnsOf(frame, columns, true, true);
}

template <class Wide, class Single>
constexpr LadderKernel KernelOfScheme() {
  return {EvaluateScheme<Wide, Single>, ReadGaugesOfScheme<Wide, Single>, Sweep,
          Combine, OpenSweep};
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
