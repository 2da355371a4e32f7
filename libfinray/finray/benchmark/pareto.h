#ifndef FINRAY_BENCHMARK_PARETO_H_
#define FINRAY_BENCHMARK_PARETO_H_

#include <string>
#include <vector>

#include "finray/benchmark/measurement.h"

namespace finray {

/// Errors that differ by less than this factor count as equal.
constexpr double kSameError = 1.02;

/// Returns true if `a`, which takes `time_ratio` times the time of `b`, is a
/// better choice than `b`. It then
///  - is 15 % faster, more than two runs on one machine differ by, or has at
///    most two thirds of the error();
///  - is no worse in the other of the two, to 5 % in time and 2 % in error();
///  - has no other error (l_c, f_c, tip, gauges) above twice that of `b`.
bool Dominates(const Measurement& a, const Measurement& b, double time_ratio);

/// The Pareto front of one task and scene: the settings that solve every frame
/// and that no other such setting dominates.
struct SceneFront {
  std::string task, scene;
  std::vector<std::size_t> front;  ///< Indices, by increasing time.
};
std::vector<SceneFront> ParetoFronts(const std::vector<Measurement>& all);

}  // namespace finray

#endif  // FINRAY_BENCHMARK_PARETO_H_
