#ifndef FINRAY_BENCHMARK_PEERS_H_
#define FINRAY_BENCHMARK_PEERS_H_

#include <string>
#include <vector>

#include "finray/benchmark/benchmark_run.h"

namespace finray {

// Programs that a lab might use instead, asked for the same answers: the
// paper's equations in SciPy and in Octave as a user's script would have them,
// and CalculiX, which bends solids. scripts/peers/ has one file for each and
// the driver run.py, which is given a job and leaves its answers, both JSON.

/// From the value of --peers: "none", "auto" or a list. Throws InputError for
/// an unknown one.
std::vector<std::string> ParsePeers(const std::string& words);

/// What run.py is asked: the finger in plain numbers and, for scenes with one
/// contact and with friction, the frames that slow solvers are measured on.
std::string PeerJob(const Finger& finger,
                    const std::vector<BenchmarkCase>& cases, bool quick);

/// Runs one peer, once, with `folder` for its files, and adds its settings and
/// what became of it to `run`. Times are by the clock, the yardstick is that
/// before and after.
void MeasurePeer(const std::string& peer, const std::string& scripts,
                 const std::string& folder, const Finger& finger,
                 const std::vector<BenchmarkCase>& cases, bool quick,
                 BenchmarkRun* run);

}  // namespace finray

#endif  // FINRAY_BENCHMARK_PEERS_H_
