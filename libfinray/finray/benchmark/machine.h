#ifndef FINRAY_BENCHMARK_MACHINE_H_
#define FINRAY_BENCHMARK_MACHINE_H_

#include <string>

namespace finray {

/// What measured times belong to. "unknown" where the system does not tell.
struct Machine {
  std::string cpu;              ///< Model name.
  int cores = 0;                ///< That this process may use.
  std::string caches;           ///< "L1d 32K, L2 1024K, L3 33M".
  std::string governor;         ///< Of the clock of core 0.
  std::string instruction_set;  ///< Of the ladder kernel: AVX2 or baseline.
  std::string system;           ///< Kernel and architecture.
};
Machine ThisMachine();

/// What was compiled, and with what.
struct Build {
  std::string version;  ///< finray's.
  std::string git;      ///< Commit when CMake last ran.
  std::string compiler;
  std::string flags;  ///< Build type and options.
  std::string ceres, eigen;
};
Build ThisBuild();

}  // namespace finray

#endif  // FINRAY_BENCHMARK_MACHINE_H_
