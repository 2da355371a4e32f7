#ifndef FINRAY_BENCHMARK_BENCHMARK_RUN_H_
#define FINRAY_BENCHMARK_BENCHMARK_RUN_H_

#include <string>
#include <vector>

#include "finray/benchmark/machine.h"
#include "finray/benchmark/measurement.h"
#include "finray/benchmark/scaling.h"

namespace finray {

/// Another program that was asked for the same answers.
struct PeerStatus {
  std::string name;     ///< scipy, octave, calculix
  std::string version;  ///< Empty if it did not run.
  std::string skipped;  ///< The reason why it did not run; else empty.
};

/// The results of one run of finray_benchmark.
struct BenchmarkRun {
  bool quick = false;
  int rounds = 0;
  std::string date;  ///< UTC, ISO 8601.
  std::string command;
  std::string finger_name, finger_path, finger_sha256;
  std::string reference;  ///< The discretization of the reference, in words.
  Facts machine, build;
  std::vector<Measurement> settings;  ///< Those of peers come last.
  std::vector<PeerStatus> peers;
  Scaling scaling;
};

}  // namespace finray

#endif  // FINRAY_BENCHMARK_BENCHMARK_RUN_H_
