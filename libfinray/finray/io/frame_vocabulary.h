#ifndef FINRAY_IO_FRAME_VOCABULARY_H_
#define FINRAY_IO_FRAME_VOCABULARY_H_

#include <string>
#include <string_view>

namespace finray {

/// Whether a name is one of the numeric columns that the tools know, such as
/// gauge_<j>_V with j = 1, 2, ... (no leading zeros).
bool IsFrameColumn(std::string_view name);

/// " (did you mean 'x'?)" with the nearest column of the tools, or "".
std::string DidYouMeanFrameColumn(const std::string& name);

}  // namespace finray

#endif  // FINRAY_IO_FRAME_VOCABULARY_H_
