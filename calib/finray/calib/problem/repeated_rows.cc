#include "finray/calib/problem/repeated_rows.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "finray/io/nan.h"
#include "finray/io/number_text.h"

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

// Calls `visit(rows)` for all frames with the same numbers, in their order.
void VisitEqual(const std::vector<CalibrationFrame>& frames,
                const std::function<void(const std::vector<int>&)>& visit) {
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
  std::vector<int> equal;
  VisitRuns(
      &rows,
      [&](int a, int b) {
        const int gauges = Compare(frames[a].gauges_V, frames[b].gauges_V);
        return gauges != 0 ? gauges
                           : Compare(Numbers(frames[a]), Numbers(frames[b]));
      },
      [&](std::size_t first, std::size_t last) {
        equal.clear();
        for (std::size_t k = first; k < last; ++k) equal.push_back(rows[k].row);
        std::sort(equal.begin(), equal.end());
        visit(equal);
      });
}

// Says for each log whether rows in turn are written twice: most runs of rows
// with the same numbers have several. A coarse converter at rest makes a few
// such runs, and a log that never changes makes one.
std::vector<bool> WrittenTwice(const std::vector<CalibrationFrame>& frames,
                               const std::vector<int>& group,
                               std::size_t logs) {
  constexpr int kLeastRuns = 5;
  std::vector<int> runs(logs, 0), long_runs(logs, 0);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const auto same = [&](std::size_t a, std::size_t b) {
      return a < frames.size() && b < frames.size() &&
             frames[a].log == frames[b].log && group[a] >= 0 &&
             group[a] == group[b];
    };
    if (same(i - 1, i)) continue;
    ++runs[frames[i].log];
    long_runs[frames[i].log] += same(i, i + 1);
  }
  std::vector<bool> twice(logs);
  for (std::size_t log = 0; log < logs; ++log) {
    twice[log] = runs[log] >= kLeastRuns && 2 * long_runs[log] > runs[log];
  }
  return twice;
}

// Which frames repeat which: an index for each frame, -1 for one of its own.
// Gauges on the bench are read several times at each radius.
std::vector<int> CopiesOf(const std::vector<CalibrationFrame>& frames,
                          const std::vector<std::vector<double>>& times_s) {
  const auto count = static_cast<int>(frames.size());
  std::vector<int> group(frames.size(), -1), copy_of(frames.size(), -1);
  std::vector<std::vector<int>> groups;
  VisitEqual(frames, [&](const std::vector<int>& equal) {
    if (equal.size() < 2 || frames[equal[0]].IsBench()) return;
    for (const int i : equal) group[i] = static_cast<int>(groups.size());
    groups.push_back(equal);
  });
  const std::vector<bool> written_twice =
      WrittenTwice(frames, group, times_s.size());
  // The group of a neighbour in the same log.
  const auto beside = [&](int i, int step) {
    const int other = i + step;
    return other >= 0 && other < count && frames[other].log == frames[i].log
               ? group[other]
               : -1;
  };
  const auto repeats = [&](int i, int earlier) {
    for (const int step : {-1, 1}) {
      const int one = beside(i, step);
      if (one >= 0 && one != group[i] && one == beside(earlier, step)) {
        return true;
      }
    }
    return false;
  };
  for (const std::vector<int>& equal : groups) {
    std::set<double> times;
    for (std::size_t k = 0; k < equal.size(); ++k) {
      const int i = equal[k];
      const int log = frames[i].log;
      const double time_s = times_s[log][frames[i].row];
      const bool same_time =
          !std::isnan(time_s) && !times.insert(time_s).second;
      if (k == 0) continue;
      if (same_time || (written_twice[log] && beside(i, -1) == group[i]) ||
          repeats(i, equal[k - 1]) || repeats(i, equal[0])) {
        copy_of[i] = equal[0];
      }
    }
  }
  return copy_of;
}

}  // namespace

void LeaveOutCopies(std::vector<std::vector<double>> times_s,
                    CalibrationLogs* logs) {
  std::vector<CalibrationFrame>& frames = logs->frames;
  const std::vector<int> copy_of = CopiesOf(frames, times_s);
  const auto words_of = [&](const CalibrationFrame& frame) {
    return logs->names[frame.log] + " row " + std::to_string(frame.row + 1);
  };
  std::vector<CalibrationFrame> kept;
  std::vector<int> rows_left(logs->paths.size(), 0);
  std::size_t first = frames.size();
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const CalibrationFrame& frame = frames[i];
    if (copy_of[i] >= 0) {
      first = std::min(first, i);
      times_s[frame.log][frame.row] = kNaN;
      continue;
    }
    ++rows_left[frame.log];
    kept.push_back(frame);
  }
  if (first < frames.size()) {
    logs->copies =
        FormatText("%zu of %zu rows", frames.size() - kept.size(),
                   frames.size()) +
        " have all the numbers of an earlier row, the first of them " +
        words_of(frames[first]) + ", which repeats " +
        words_of(frames[copy_of[first]]) + "; they count once";
    frames = std::move(kept);
  }
  std::vector<int> new_log(logs->paths.size());
  const auto all = static_cast<int>(logs->paths.size());
  int left = 0;
  for (int log = 0; log < all; ++log) {
    new_log[log] = left;
    if (rows_left[log] == 0 && !times_s[log].empty()) {
      logs->copies += "; nothing is left of " + logs->names[log];
      logs->left_out.push_back(logs->paths[log]);
      continue;
    }
    logs->paths[left] = logs->paths[log];
    logs->names[left] = logs->names[log];
    logs->times.push_back(RowTimes::Of(times_s[log]));
    ++left;
  }
  logs->paths.resize(left);
  logs->names.resize(left);
  for (CalibrationFrame& frame : frames) frame.log = new_log[frame.log];
}

void MarkRepeatedRows(const Plan& plan, CalibrationLogs* logs) {
  std::vector<CalibrationFrame>& frames = logs->frames;
  const auto count = static_cast<int>(frames.size());
  VisitEqual(frames, [&](const std::vector<int>& equal) {
    for (const int i : equal) {
      frames[i].readings_std_times =
          std::sqrt(static_cast<double>(equal.size()));
    }
  });

  std::vector<KeyedRow> rows;
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
