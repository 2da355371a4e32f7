#ifndef FINRAY_BENCHMARK_BENCHMARK_FILES_H_
#define FINRAY_BENCHMARK_BENCHMARK_FILES_H_

#include <string>

#include "finray/benchmark/benchmark_run.h"

namespace finray {

/// benchmark.json: the run, and what follows from it (fronts, recommendations,
/// checks of the defaults).
std::string BenchmarkJson(const BenchmarkRun& run);

/// benchmark.csv: a row a setting.
std::string BenchmarkCsv(const BenchmarkRun& run);

/// Reads back what a comparison needs: settings, machine, build. `path` is a
/// benchmark.json or a folder that holds one. Throws InputError with the place.
BenchmarkRun ReadBenchmark(const std::string& path);

}  // namespace finray

#endif  // FINRAY_BENCHMARK_BENCHMARK_FILES_H_
