#include "finray/ladder/instruction_set.h"
#include "finray/ladder/ladder_kernel.h"

namespace finray {

// Each compilation of ladder_kernel.cc has one of these.
using FindKernel = const LadderKernel&(Scheme scheme, bool stretch);
inline namespace generic {
FindKernel KernelOf;
}
namespace avx2 {
FindKernel KernelOf;
}
namespace avx512 {
FindKernel KernelOf;
}

const LadderKernel& FindLadderKernel(Scheme scheme, bool stretch, int set) {
  static constexpr FindKernel* kKernels[] = FINRAY_COMPILATIONS(KernelOf);
  return kKernels[BestInstructionSet() + set](scheme, stretch);
}

const LadderKernel& FindLadderKernel(Scheme scheme, bool stretch) {
  return FindLadderKernel(scheme, stretch, 0);
}

}  // namespace finray
