#ifndef FINRAY_BENCHMARK_PEERS_H_
#define FINRAY_BENCHMARK_PEERS_H_

#include <string>
#include <vector>

#include "finray/benchmark/benchmark_run.h"

namespace finray {

// Peers are programs that a lab might use instead of finray. They solve the
// same frames: the paper's equations in SciPy and in Octave, as a user's script
// would have them, CalculiX, which bends solids, an exact beam in GetFEM, and
// links in MuJoCo, which come to rest. scripts/peers/ has files for each, and
// run.py, which reads a job and writes the answers, both as JSON.

/// Parses the value of --peers: "none", "auto" or a list. Throws InputError for
/// an unknown name.
std::vector<std::string> ParsePeers(const std::string& words);

/// Returns the job for run.py: the finger in plain numbers and some frames of
/// the scenes one_contact and friction, of which `cases` must have both.
std::string PeerJob(const Finger& finger,
                    const std::vector<BenchmarkCase>& cases, bool quick);

/// Runs one peer once, with its files in `folder`, and adds its settings and
/// its status to `run`. Times are by the clock; the yardstick is the mean of
/// one before and one after.
void MeasurePeer(const std::string& peer, const std::string& folder,
                 const Finger& finger, const std::vector<BenchmarkCase>& cases,
                 BenchmarkRun* run);

}  // namespace finray

#endif  // FINRAY_BENCHMARK_PEERS_H_
