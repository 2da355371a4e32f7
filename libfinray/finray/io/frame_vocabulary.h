#ifndef FINRAY_IO_FRAME_VOCABULARY_H_
#define FINRAY_IO_FRAME_VOCABULARY_H_

#include <string>
#include <string_view>
#include <vector>

namespace finray {

/// The vocabulary of numeric columns; '#' stands for an index that starts from
/// 1.
const std::vector<std::string>& FrameColumnPatterns();

/// Says whether a name belongs to the vocabulary of numeric columns, such as
/// gauge_<j>_V with j = 1, 2, ... (no leading zeros).
bool IsFrameColumn(std::string_view name);

/// Says whether inf is a value of a column: a cylinder of infinite radius is a
/// plane, a gauge with an open cable reads anything. In others it is an error.
bool MayBeInfinite(std::string_view name);

/// The largest magnitude of what a log or a load may hold, in the units of its
/// column, and of its times. Sums of many squares stay far from overflow, and
/// places far from where rounding hides a finger.
constexpr double kLargestMeasured = 1e9, kLargestTime_s = 1e12;

/// Returns the largest magnitude in a column. It is infinite for readings of
/// gauges, which estimators judge row by row, and for what is computed.
double LargestIn(std::string_view name);

/// Returns " (did you mean 'x'?)" with the nearest name of the vocabulary, or
/// "".
std::string DidYouMeanFrameColumn(const std::string& name);

/// Returns "no column 'x'" and the nearest of `columns`, or all of them if none
/// is near.
std::string NoColumn(const std::string& name,
                     const std::vector<std::string>& columns);

}  // namespace finray

#endif  // FINRAY_IO_FRAME_VOCABULARY_H_
