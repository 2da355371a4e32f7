#ifndef FINRAY_BENCHMARK_YARDSTICK_H_
#define FINRAY_BENCHMARK_YARDSTICK_H_

namespace finray {

/// CPU time of this thread, s.
double ThreadSeconds();

/// The time, us, that this thread takes for a fixed piece of work which no
/// change of the library touches: elimination of a dense 48 x 48 system, a
/// tenth of a millisecond or so. What other processes and the clock of the core
/// do to a measurement they do to this beside it, so the ratio of both is
/// comparable over a noisy hour and between builds.
double YardstickUs();

}  // namespace finray

#endif  // FINRAY_BENCHMARK_YARDSTICK_H_
