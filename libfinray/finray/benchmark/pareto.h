#ifndef FINRAY_BENCHMARK_PARETO_H_
#define FINRAY_BENCHMARK_PARETO_H_

#include <vector>

#include "finray/benchmark/measurement.h"

namespace finray {

struct TimeAndError {
  double time, error;
};

// Two times within this share of each other, and two errors, are the same:
// measured times differ so much from run to run.
constexpr double kSameTime = 0.05;
constexpr double kSameError = 0.05;

/// Whether `a` is no worse than `b` in both and better in one.
bool Dominates(const TimeAndError& a, const TimeAndError& b);

/// The points that no other one dominates, by increasing time.
std::vector<std::size_t> ParetoFront(const std::vector<TimeAndError>& points);

/// The front of one task and scene among the settings that solve every frame:
/// indices into `all`. Errors below what doubles resolve count as that.
struct SceneFront {
  std::string task, scene;
  std::vector<std::size_t> front;
};
std::vector<SceneFront> ParetoFronts(const std::vector<Measurement>& all);

/// Time and error of a measurement as ParetoFronts takes them.
TimeAndError PointOf(const Measurement& measurement);

}  // namespace finray

#endif  // FINRAY_BENCHMARK_PARETO_H_
