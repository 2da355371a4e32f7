#ifndef FINRAY_IO_FRAME_VOCABULARY_H_
#define FINRAY_IO_FRAME_VOCABULARY_H_

#include <string>
#include <string_view>
#include <vector>

namespace finray {

/// Whether a name is one of the numeric columns that the tools know, such as
/// gauge_<j>_V with j = 1, 2, ... (no leading zeros).
bool IsFrameColumn(std::string_view name);

/// Whether "inf" is a value of the column: a cylinder of that radius is flat.
bool MayBeInfinite(std::string_view name);

/// " (did you mean 'x'?)" with the nearest column of the tools, or "".
std::string DidYouMeanFrameColumn(const std::string& name);

/// "no column 'x'" and the nearest of the columns there are, or all of them.
std::string NoColumn(const std::string& name,
                     const std::vector<std::string>& columns);

}  // namespace finray

#endif  // FINRAY_IO_FRAME_VOCABULARY_H_
