#include "finray/calib/problem/repeated_rows.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <utility>
#include <vector>

namespace finray {
namespace {

// Compares numbers of which some may not be measured: those come last.
int Compare(double a, double b) {
  if (std::isnan(a) || std::isnan(b)) return std::isnan(a) - std::isnan(b);
  return (a > b) - (a < b);
}

int Compare(const std::vector<double>& a, const std::vector<double>& b) {
  for (std::size_t i = 0; i < a.size() && i < b.size(); ++i) {
    if (const int order = Compare(a[i], b[i])) return order;
  }
  return static_cast<int>(a.size()) - static_cast<int>(b.size());
}

// Everything that a row measures, at any time.
std::vector<double> Numbers(const CalibrationFrame& frame) {
  std::vector<double> numbers = frame.gauges_V;
  for (const double number :
       {frame.force_N, frame.force_xy_N.x(), frame.force_xy_N.y(),
        frame.object_mm.x(), frame.object_mm.y(), frame.contact_mm,
        frame.tip_mm.x(), frame.tip_mm.y(), frame.cylinder_radius_mm}) {
    numbers.push_back(number);
  }
  for (const SeenPin& pin : frame.pins) {
    numbers.insert(numbers.end(), {pin.at_mm.x(), pin.at_mm.y()});
  }
  return numbers;
}

// Calls `visit(first, last)` for each run of rows that `order` calls equal.
void VisitRuns(std::vector<int>* rows,
               const std::function<int(int, int)>& order,
               const std::function<void(std::size_t, std::size_t)>& visit) {
  std::sort(rows->begin(), rows->end(),
            [&](int a, int b) { return order(a, b) < 0; });
  for (std::size_t first = 0; first < rows->size();) {
    std::size_t last = first + 1;
    while (last < rows->size() && order((*rows)[first], (*rows)[last]) == 0) {
      ++last;
    }
    visit(first, last);
    first = last;
  }
}

}  // namespace

void MarkRepeatedRows(const Plan& plan, CalibrationLogs* logs) {
  std::vector<CalibrationFrame>& frames = logs->frames;
  std::vector<int> rows(frames.size());
  std::iota(rows.begin(), rows.end(), 0);
  VisitRuns(
      &rows,
      [&](int a, int b) {
        // Gauges nearly always differ.
        const int gauges = Compare(frames[a].gauges_V, frames[b].gauges_V);
        return gauges != 0 ? gauges
                           : Compare(Numbers(frames[a]), Numbers(frames[b]));
      },
      [&](std::size_t first, std::size_t last) {
        for (std::size_t k = first; k < last; ++k) {
          frames[rows[k]].readings_std_times =
              std::sqrt(static_cast<double>(last - first));
        }
      });

  const auto place = [&](int i) -> std::vector<double> {
    const CalibrationFrame& frame = frames[i];
    if (!frame.object_mm.allFinite()) {
      return {
          std::round(frame.contact_mm / (kSamePlace * plan.contact_std_mm))};
    }
    const double cell = kSamePlace * plan.object_std_mm;
    return {std::round(frame.object_mm.x() / cell),
            std::round(frame.object_mm.y() / cell)};
  };
  rows.erase(
      std::remove_if(rows.begin(), rows.end(),
                     [&](int i) {
                       return std::isnan(place(i)[0]) ||
                              !(frames[i].contact || frames[i].undecided);
                     }),
      rows.end());
  VisitRuns(
      &rows,
      [&](int a, int b) {
        const int log = frames[a].log - frames[b].log;
        return log != 0 ? log : Compare(place(a), place(b));
      },
      [&](std::size_t first, std::size_t last) {
        for (std::size_t k = first; k < last; ++k) {
          frames[rows[k]].place_std_times =
              std::max(frames[rows[k]].readings_std_times,
                       std::sqrt(static_cast<double>(last - first)));
        }
      });
}

}  // namespace finray
