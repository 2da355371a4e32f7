#ifndef FINRAY_BENCHMARK_BENCHMARK_FILES_H_
#define FINRAY_BENCHMARK_BENCHMARK_FILES_H_

#include <string>

#include "finray/benchmark/benchmark_run.h"

namespace finray {

/// Returns benchmark.json: the run and its conclusions, that is Pareto fronts,
/// recommendations and checks of the defaults.
std::string BenchmarkJson(const BenchmarkRun& run);

/// Returns benchmark.csv, one row for each setting.
std::string BenchmarkCsv(const BenchmarkRun& run);

/// Reads what a comparison needs: settings, machine and build. `path` is a
/// benchmark.json or the folder of one. Throws InputError with the place.
BenchmarkRun ReadBenchmark(const std::string& path);

}  // namespace finray

#endif  // FINRAY_BENCHMARK_BENCHMARK_FILES_H_
