#ifndef FINRAY_TESTS_CALIB_LOG_ROWS_H_
#define FINRAY_TESTS_CALIB_LOG_ROWS_H_

#include <vector>

#include "finray/io/frame_table.h"

namespace finray {

/// Some rows of a table of numbers, any of them more than once.
inline FrameTable RowsOf(const FrameTable& all,
                         const std::vector<std::size_t>& rows) {
  FrameTable some(rows.size());
  for (const std::string& name : all.headers()) {
    const std::vector<double>& from = all.Numbers(name);
    std::vector<double>& to = some.MutableNumbers(name);
    for (std::size_t i = 0; i < rows.size(); ++i) to[i] = from[rows[i]];
  }
  return some;
}

/// Rows of which `keep(all, row)` says so.
template <class Keep>
FrameTable RowsWhere(const FrameTable& all, const Keep& keep) {
  std::vector<std::size_t> rows;
  for (std::size_t i = 0; i < all.rows(); ++i) {
    if (keep(all, i)) rows.push_back(i);
  }
  return RowsOf(all, rows);
}

}  // namespace finray

#endif  // FINRAY_TESTS_CALIB_LOG_ROWS_H_
