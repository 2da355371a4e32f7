#include "finray/ladder/instruction_set.h"

namespace finray {
namespace {

struct InstructionSet {
  const char* name;
  int vector_bytes;
  bool (*runs)();
};

constexpr InstructionSet kSets[] = {
#ifdef FINRAY_X86_KERNELS
    {"AVX-512", 64,
     [] {
       return __builtin_cpu_supports("avx512f") &&
              __builtin_cpu_supports("avx512dq") &&
              __builtin_cpu_supports("avx512vl") &&
              __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
     }},
    {"AVX2", 32,
     [] {
       return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
     }},
#endif
    {"baseline", 32, [] { return true; }}};
constexpr int kSetCount = sizeof(kSets) / sizeof(kSets[0]);

}  // namespace

int BestInstructionSet() {
  static const int best = [] {
    int set = 0;
    while (!kSets[set].runs()) ++set;
    return set;
  }();
  return best;
}

int InstructionSets() { return kSetCount - BestInstructionSet(); }

const char* InstructionSetName(int set) {
  return kSets[BestInstructionSet() + set].name;
}

int VectorBytes() { return kSets[BestInstructionSet()].vector_bytes; }

}  // namespace finray
