#ifndef FINRAY_IO_SHOWN_TEXT_H_
#define FINRAY_IO_SHOWN_TEXT_H_

#include <string>
#include <string_view>

namespace finray {

/// Text for a message of one line: control characters and line ends become
/// spaces, and text beyond 1000 bytes is cut off.
std::string ShownLine(std::string_view text);

/// Text from a user's file for a message: in quotes, and cut after 40 bytes.
std::string ShownText(std::string_view text);

}  // namespace finray

#endif  // FINRAY_IO_SHOWN_TEXT_H_
