#ifndef FINRAY_BENCHMARK_RECOMMENDATION_H_
#define FINRAY_BENCHMARK_RECOMMENDATION_H_

#include <string>
#include <vector>

#include "finray/benchmark/measurement.h"

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
/// takes a tenth of the period at most, and of equally accurate ones the
/// fastest. Batch: the fastest estimate of a log whose l_c is off by no more
/// than a hundredth of what noise does to it (1e-3 mm). Reference: the most
/// accurate of all that sense.
std::vector<Recommendation> Recommend(const std::vector<Measurement>& all);

/// Whether what finray uses by default is a good choice: in each way of use it
/// lies on the Pareto front of the settings used in that way, and no other of
/// them is both 20 % faster and more accurate.
struct DefaultCheck {
  std::string id;
  bool on_front;
  std::vector<std::string> better;  ///< Ids that are both.
  bool holds() const { return on_front && better.empty(); }
};
std::vector<DefaultCheck> CheckDefaults(const std::vector<Measurement>& all);

}  // namespace finray

#endif  // FINRAY_BENCHMARK_RECOMMENDATION_H_
