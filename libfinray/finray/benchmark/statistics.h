#ifndef FINRAY_BENCHMARK_STATISTICS_H_
#define FINRAY_BENCHMARK_STATISTICS_H_

#include <vector>

namespace finray {

/// Returns the q-quantile (0 .. 1), linear between sorted values; NaN of no
/// values.
double Quantile(std::vector<double> values, double q);
inline double Median(const std::vector<double>& values) {
  return Quantile(values, 0.5);
}

struct Interval {
  double low, high;
};

/// Returns a bootstrap interval of the ratio of q-quantiles, b over a: 2000
/// times both samples are drawn again with replacement, and the tails beyond
/// `confidence` are cut off. The same samples give the same interval.
Interval RatioOfQuantiles(const std::vector<double>& a,
                          const std::vector<double>& b, double q,
                          double confidence);

// In yardstick.cc.

/// Returns the CPU time of this thread in s.
double ThreadSeconds();

/// Returns the time in us that this thread takes for a fixed piece of work, the
/// elimination of a dense 48 x 48 system, about a tenth of a millisecond. No
/// change of the library touches this work, and other processes and the clock
/// of the core slow it down as they do a measurement beside it. The ratio of
/// both is therefore comparable over a noisy hour and between builds.
double YardstickUs();

}  // namespace finray

#endif  // FINRAY_BENCHMARK_STATISTICS_H_
