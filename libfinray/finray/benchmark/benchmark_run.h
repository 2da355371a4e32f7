#ifndef FINRAY_BENCHMARK_BENCHMARK_RUN_H_
#define FINRAY_BENCHMARK_BENCHMARK_RUN_H_

#include <map>
#include <string>
#include <vector>

#include "finray/benchmark/latency.h"
#include "finray/benchmark/measurement.h"
#include "finray/benchmark/noise_floor.h"

namespace finray {

/// Facts under their names in benchmark.json; "unknown" where the system does
/// not tell.
using Facts = std::map<std::string, std::string>;

/// Returns the facts of this machine that times depend on: cpu, cores, caches,
/// governor (of the frequency of core 0), instruction_set (of the ladder
/// kernel) and system.
Facts ThisMachine();

/// Returns the facts of this build: version, git (commit when CMake last ran),
/// compiler, flags, ceres and eigen.
Facts ThisBuild();

/// Another program that was asked for the same answers.
struct PeerStatus {
  std::string name;     ///< scipy, octave, calculix, getfem, mujoco
  std::string version;  ///< Empty if it did not run.
  std::string skipped;  ///< The reason why it did not run; else empty.
};

/// The results of one run of finray_benchmark.
struct BenchmarkRun {
  bool quick = false;
  int rounds = 0;
  std::string date;  ///< UTC, ISO 8601.
  std::string command;
  std::string reference;  ///< The discretization of the reference, in words.
  Facts finger;           ///< name, path, sha256
  Facts machine, build;
  std::vector<NoiseFloor> noise;      ///< Of each scene.
  std::vector<Measurement> settings;  ///< Those of peers come last.
  std::vector<PeerStatus> peers;
  Scaling scaling;
  std::vector<Latency> latencies;
};

/// Returns benchmark.json: the run and its conclusions, that is Pareto fronts,
/// recommendations and checks of the defaults.
std::string BenchmarkJson(const BenchmarkRun& run);

/// Returns benchmark.csv, one row for each setting.
std::string BenchmarkCsv(const BenchmarkRun& run);

/// Reads what a comparison needs: settings, machine and build. `path` is a
/// benchmark.json or the folder of one. Throws InputError with the place.
BenchmarkRun ReadBenchmark(const std::string& path);

}  // namespace finray

#endif  // FINRAY_BENCHMARK_BENCHMARK_RUN_H_
