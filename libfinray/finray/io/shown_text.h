#ifndef FINRAY_IO_SHOWN_TEXT_H_
#define FINRAY_IO_SHOWN_TEXT_H_

#include <string>
#include <string_view>

namespace finray {

/// Returns text for a message of one line. Control characters and line ends
/// become spaces, and text beyond 1000 bytes is cut off.
std::string ShownLine(std::string_view text);

/// Returns text from a user's file for a message: in quotes, and cut after 40
/// bytes.
std::string ShownText(std::string_view text);

}  // namespace finray

#endif  // FINRAY_IO_SHOWN_TEXT_H_
