#include "finray/residuals/linear_signal.h"

#include <algorithm>
#include <cmath>

namespace finray {

void LinearSignal::Add(double time_s, double value) {
  if (std::isnan(time_s) || std::isnan(value)) return;
  if (!times_s_.empty() && time_s <= times_s_.back()) return;
  times_s_.push_back(time_s);
  values_.push_back(value);
}

LinearSignal::Point LinearSignal::At(double time_s) const {
  if (times_s_.empty()) return {std::nan(""), 0};
  const auto count = static_cast<std::ptrdiff_t>(times_s_.size());
  // The slope of the piece that ends at a sample.
  const auto slope = [&](std::ptrdiff_t end) {
    if (end <= 0 || end >= count) return 0.0;
    return (values_[end] - values_[end - 1]) /
           (times_s_[end] - times_s_[end - 1]);
  };
  const auto at = std::lower_bound(times_s_.begin(), times_s_.end(), time_s) -
                  times_s_.begin();
  if (at < count && times_s_[at] == time_s) {
    return {values_[at], (slope(at) + slope(at + 1)) / 2};
  }
  if (at == 0) return {values_[0], 0};
  return {values_[at - 1] + slope(at) * (time_s - times_s_[at - 1]), slope(at)};
}

LinearSignal::Point LinearSignal::Change(double time_s, double by_s) const {
  if (times_s_.empty() || std::isnan(time_s)) return {0, 0};
  const Point later = At(time_s + by_s);
  return {by_s == 0 ? 0 : later.value - At(time_s).value, later.slope};
}

}  // namespace finray
