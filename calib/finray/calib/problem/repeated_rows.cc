#include "finray/calib/problem/repeated_rows.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <utility>
#include <vector>

#include "finray/io/nan.h"

namespace finray {
namespace {

// Compares numbers of which some may not be measured: those come last.
int Compare(double a, double b) {
  if (std::isnan(a) || std::isnan(b)) return std::isnan(a) - std::isnan(b);
  return (a > b) - (a < b);
}

template <class Numbers>
int Compare(const Numbers& a, const Numbers& b) {
  for (std::size_t i = 0; i < a.size() && i < b.size(); ++i) {
    if (const int order = Compare(a[i], b[i])) return order;
  }
  return static_cast<int>(a.size()) - static_cast<int>(b.size());
}

// A row beside its first numbers, which nearly always differ: a sort by them
// does not read the frames, which are all over the heap.
struct KeyedRow {
  std::array<double, 3> key;
  int row;
};

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

// Calls `visit(first, last)` for each run of rows whose keys are equal and that
// `rest` calls equal.
void VisitRuns(std::vector<KeyedRow>* rows,
               const std::function<int(int, int)>& rest,
               const std::function<void(std::size_t, std::size_t)>& visit) {
  const auto order = [&](const KeyedRow& a, const KeyedRow& b) {
    const int by_key = Compare(a.key, b.key);
    return by_key != 0 ? by_key : rest(a.row, b.row);
  };
  std::sort(rows->begin(), rows->end(),
            [&](const auto& a, const auto& b) { return order(a, b) < 0; });
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
  const auto count = static_cast<int>(frames.size());
  std::vector<KeyedRow> rows;
  rows.reserve(frames.size());
  for (int i = 0; i < count; ++i) {
    const std::vector<double>& gauges = frames[i].gauges_V;
    KeyedRow keyed{{kNaN, kNaN, kNaN}, i};
    std::copy_n(gauges.begin(), std::min(gauges.size(), keyed.key.size()),
                keyed.key.begin());
    rows.push_back(keyed);
  }
  VisitRuns(
      &rows,
      [&](int a, int b) {
        const int gauges = Compare(frames[a].gauges_V, frames[b].gauges_V);
        return gauges != 0 ? gauges
                           : Compare(Numbers(frames[a]), Numbers(frames[b]));
      },
      [&](std::size_t first, std::size_t last) {
        for (std::size_t k = first; k < last; ++k) {
          frames[rows[k].row].readings_std_times =
              std::sqrt(static_cast<double>(last - first));
        }
      });

  rows.clear();
  for (int i = 0; i < count; ++i) {
    const CalibrationFrame& frame = frames[i];
    if (!frame.contact && !frame.undecided) continue;
    const bool object = frame.object_mm.allFinite();
    if (!object && std::isnan(frame.contact_mm)) continue;
    const double cell =
        kSamePlace * (object ? plan.object_std_mm : plan.contact_std_mm);
    const double x = object ? frame.object_mm.x() : frame.contact_mm;
    const double y = object ? frame.object_mm.y() : kNaN;
    rows.push_back({{static_cast<double>(frame.log), std::round(x / cell),
                     std::round(y / cell)},
                    i});
  }
  VisitRuns(
      &rows, [](int, int) { return 0; },
      [&](std::size_t first, std::size_t last) {
        for (std::size_t k = first; k < last; ++k) {
          CalibrationFrame& frame = frames[rows[k].row];
          frame.place_std_times =
              std::max(frame.readings_std_times,
                       std::sqrt(static_cast<double>(last - first)));
        }
      });
}

}  // namespace finray
