#include "finray/ladder/ladder_kernel.h"

namespace finray {

// Each compilation of ladder_kernel.cc has one of these.
inline namespace generic {
const LadderKernel& KernelOf(Scheme scheme, bool stretch);
}
#ifdef FINRAY_HAS_AVX2
namespace avx2 {
const LadderKernel& KernelOf(Scheme scheme, bool stretch);
}
#endif

namespace {

struct InstructionSet {
  const char* name;
  const LadderKernel& (*kernel)(Scheme, bool);
};

bool HasAvx2() {
#ifdef FINRAY_HAS_AVX2
  return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
#else
  return false;
#endif
}

constexpr InstructionSet kSets[] = {
#ifdef FINRAY_HAS_AVX2
    {"AVX2", avx2::KernelOf},
#endif
    {"baseline", generic::KernelOf}};
constexpr int kSetCount = sizeof(kSets) / sizeof(kSets[0]);

// Index of the best set that this machine can run.
int BestSet() {
  static const int best = kSetCount > 1 && !HasAvx2() ? 1 : 0;
  return best;
}

}  // namespace

int LadderInstructionSets() { return kSetCount - BestSet(); }

const char* LadderInstructionSetName(int set) {
  return kSets[BestSet() + set].name;
}

const LadderKernel& FindLadderKernel(Scheme scheme, bool stretch, int set) {
  return kSets[BestSet() + set].kernel(scheme, stretch);
}

const LadderKernel& FindLadderKernel(Scheme scheme, bool stretch) {
  return FindLadderKernel(scheme, stretch, 0);
}

}  // namespace finray
