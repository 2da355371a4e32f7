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

}  // namespace finray

#endif  // FINRAY_BENCHMARK_STATISTICS_H_
