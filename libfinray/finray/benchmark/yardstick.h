#ifndef FINRAY_BENCHMARK_YARDSTICK_H_
#define FINRAY_BENCHMARK_YARDSTICK_H_

namespace finray {

/// Returns the CPU time of this thread in s.
double ThreadSeconds();

/// Returns the time in us that this thread takes for a fixed piece of work, the
/// elimination of a dense 48 x 48 system, about a tenth of a millisecond. No
/// change of the library touches this work, and other processes and the clock
/// of the core slow it down as they do a measurement beside it. The ratio of
/// both is therefore comparable over a noisy hour and between builds.
double YardstickUs();

}  // namespace finray

#endif  // FINRAY_BENCHMARK_YARDSTICK_H_
