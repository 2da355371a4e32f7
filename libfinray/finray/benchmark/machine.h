#ifndef FINRAY_BENCHMARK_MACHINE_H_
#define FINRAY_BENCHMARK_MACHINE_H_

#include <map>
#include <string>

namespace finray {

/// Facts under their names in benchmark.json; "unknown" where the system does
/// not tell.
using Facts = std::map<std::string, std::string>;

/// Returns the number of cores that this process may use.
int UsableCores();

/// Returns the facts of this machine that times depend on: cpu, cores, caches,
/// governor (of the frequency of core 0), instruction_set (of the ladder
/// kernel) and system.
Facts ThisMachine();

/// Returns the facts of this build: version, git (commit when CMake last ran),
/// compiler, flags, ceres and eigen.
Facts ThisBuild();

}  // namespace finray

#endif  // FINRAY_BENCHMARK_MACHINE_H_
