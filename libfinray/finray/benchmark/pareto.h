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

/// Whether `a` dominates `b` in time and error() (`time_ratio`: a's over b's),
/// and in no other error (l_c, f_c, tip, gauges) has more than twice of b's.
/// Errors below what doubles resolve count as that.
bool DominatesSetting(const Measurement& a, const Measurement& b,
                      double time_ratio);

/// The front of one task and scene, by DominatesSetting among the settings that
/// solve every frame: indices into `all`, by increasing time.
struct SceneFront {
  std::string task, scene;
  std::vector<std::size_t> front;
};
std::vector<SceneFront> ParetoFronts(const std::vector<Measurement>& all);

/// Time, in yardsticks, and error() of a measurement as DominatesSetting takes
/// them.
TimeAndError PointOf(const Measurement& measurement);

}  // namespace finray

#endif  // FINRAY_BENCHMARK_PARETO_H_
