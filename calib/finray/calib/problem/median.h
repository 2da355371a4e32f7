#ifndef FINRAY_CALIB_PROBLEM_MEDIAN_H_
#define FINRAY_CALIB_PROBLEM_MEDIAN_H_

#include <algorithm>
#include <vector>

namespace finray {

/// Returns the middle value, or the upper of both if their number is even.
/// There must be one.
inline double Median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<long>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace finray

#endif  // FINRAY_CALIB_PROBLEM_MEDIAN_H_
