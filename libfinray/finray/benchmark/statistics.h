#ifndef FINRAY_BENCHMARK_STATISTICS_H_
#define FINRAY_BENCHMARK_STATISTICS_H_

#include <vector>

namespace finray {

/// The q-quantile (0 .. 1) of values, linear between order statistics; NaN of
/// none.
double Quantile(std::vector<double> values, double q);
inline double Median(const std::vector<double>& values) {
  return Quantile(values, 0.5);
}

struct Interval {
  double low, high;
};

/// What the q-quantile of b over that of a may be, by the bootstrap: both
/// samples are drawn anew, with replacement, 2000 times, and the tails of
/// `confidence` are cut off. The same samples always give the same interval.
Interval RatioOfQuantiles(const std::vector<double>& a,
                          const std::vector<double>& b, double q,
                          double confidence);

/// The slope of log(y) over log(x) by least squares; NaN of less than two.
double LogLogSlope(const std::vector<double>& x, const std::vector<double>& y);

}  // namespace finray

#endif  // FINRAY_BENCHMARK_STATISTICS_H_
