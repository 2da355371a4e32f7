#include "finray/ladder/ladder_kernel.h"

namespace finray {

// Each compilation of ladder_kernel.cc has one of these.
inline namespace generic {
const LadderKernel& KernelOf(Scheme scheme, bool stretch);
}
#ifdef FINRAY_X86_KERNELS
namespace avx2 {
const LadderKernel& KernelOf(Scheme scheme, bool stretch);
}
namespace avx512 {
const LadderKernel& KernelOf(Scheme scheme, bool stretch);
}
#endif

namespace {

struct InstructionSet {
  const char* name;
  bool (*runs)();
  const LadderKernel& (*kernel)(Scheme, bool);
  int vector_bytes;
};

// Best first.
const InstructionSet kSets[] = {
#ifdef FINRAY_X86_KERNELS
    {"AVX-512",
     [] {
       return __builtin_cpu_supports("avx512f") &&
              __builtin_cpu_supports("avx512dq") &&
              __builtin_cpu_supports("avx512vl");
     },
     avx512::KernelOf, 64},
    {"AVX2",
     [] {
       return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
     },
     avx2::KernelOf, 32},
#endif
    {"baseline", [] { return true; }, generic::KernelOf, 32}};
constexpr int kSetCount = sizeof(kSets) / sizeof(kSets[0]);

// Index of the best set that this machine can run.
int BestSet() {
  static const int best = [] {
    int set = 0;
    while (!kSets[set].runs()) ++set;
    return set;
  }();
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

int LadderVectorBytes() { return kSets[BestSet()].vector_bytes; }

int FrameLanes() {
  return LadderVectorBytes() / static_cast<int>(sizeof(double));
}

template <class T>
const FramesKernel<T>* FindFramesKernel(Scheme scheme, bool stretch) {
  for (int set = 0; set < LadderInstructionSets(); ++set) {
    const auto& kernel = OfFrames<T>(FindLadderKernel(scheme, stretch, set));
    if (kernel.evaluate != nullptr) return &kernel;
  }
  return nullptr;
}
template const FramesKernel<FourFrames>* FindFramesKernel(Scheme, bool);
template const FramesKernel<EightFrames>* FindFramesKernel(Scheme, bool);

}  // namespace finray
