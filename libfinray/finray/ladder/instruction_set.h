#ifndef FINRAY_LADDER_INSTRUCTION_SET_H_
#define FINRAY_LADDER_INSTRUCTION_SET_H_

namespace finray {

// Kernels are compiled once for every instruction set worth having
// (CMakeLists.txt), each in a namespace of its own, and the best one that this
// machine can run is chosen at run time. FINRAY_COMPILATIONS lists those of a
// function, best first.
#ifdef FINRAY_X86_KERNELS
#define FINRAY_COMPILATIONS(name) \
  { avx512::name, avx2::name, generic::name }
#else
#define FINRAY_COMPILATIONS(name) \
  { generic::name }
#endif

/// The place of the best set in the list.
int BestInstructionSet();

/// The number of sets from the best one on, which this machine can run, and the
/// name of each, as "AVX2"; `set` counts from the best one.
int InstructionSets();
const char* InstructionSetName(int set);

/// The number of bytes of the best set's vectors in ladder/lanes.h.
int VectorBytes();

}  // namespace finray

#endif  // FINRAY_LADDER_INSTRUCTION_SET_H_
