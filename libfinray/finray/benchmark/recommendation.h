#ifndef FINRAY_BENCHMARK_RECOMMENDATION_H_
#define FINRAY_BENCHMARK_RECOMMENDATION_H_

#include <string>
#include <vector>

#include "finray/benchmark/measurement.h"
#include "finray/benchmark/statistics.h"

namespace finray {

/// A use and the setting for it, out of what was measured with one contact.
struct Recommendation {
  std::string use;  ///< 30_Hz, 1_kHz, batch, reference
  std::string id;   ///< Empty if none serves.
  std::string why;  ///< The rule, in words.
  double limit_us;  ///< Time a frame that the use leaves; NaN: any.
  double time_us;   ///< The slow frames' where there are such, else median.
  double margin;    ///< limit_us / time_us
  double error_mm;  ///< of l_c
};

/// 30 Hz and 1 kHz: the most accurate live estimate whose slowest hundredth
/// takes a tenth of the period at most. Of those about as accurate (no error
/// above twice the least) the fastest, or the default if that is as fast to
/// 25 %. Batch: the fastest estimate of a log whose l_c is off by no more than
/// a hundredth of what noise does to it (1e-3 mm). Reference: the most accurate
/// of all that sense.
std::vector<Recommendation> Recommend(const std::vector<Measurement>& all);

/// Whether what finray uses by default is a good choice: in each way of use it
/// lies on the Pareto front (pareto.h) of the settings used in that way, and no
/// other of them is both 20 % faster and more accurate. A time is faster if the
/// 95 % interval of its ratio over the rounds says so.
struct DefaultCheck {
  std::string id;
  bool on_front = true;
  std::vector<std::string> dominated_by;  ///< Ids.
  std::vector<std::string> better;        ///< 20 % faster and more accurate.
  /// The fastest of those whose error of l_c is no more than twice the
  /// default's, and its time over the default's.
  std::string rival;
  double rival_time = 1;
  Interval rival_interval = {1, 1};
  bool holds() const { return on_front && better.empty(); }
};
std::vector<DefaultCheck> CheckDefaults(const std::vector<Measurement>& all);

}  // namespace finray

#endif  // FINRAY_BENCHMARK_RECOMMENDATION_H_
