#ifndef FINRAY_BENCHMARK_PARETO_H_
#define FINRAY_BENCHMARK_PARETO_H_

#include <vector>

#include "finray/benchmark/measurement.h"

namespace finray {

struct TimeAndError {
  double time, error;
};

/// Whether `a` is better than `b`: clearly so in one (faster by 15 %, which is
/// what two runs of one machine may differ by, or of two thirds of its error)
/// and in the other no worse (5 % in time, 2 % in the error).
bool Dominates(const TimeAndError& a, const TimeAndError& b);

/// The points that no other one dominates, by increasing time.
std::vector<std::size_t> ParetoFront(const std::vector<TimeAndError>& points);

/// Errors that are as good as equal.
constexpr double kSameError = 1.02;

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
