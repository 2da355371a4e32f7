#ifndef FINRAY_IO_SHOWN_TEXT_H_
#define FINRAY_IO_SHOWN_TEXT_H_

#include <string>
#include <string_view>

namespace finray {

/// Text as it goes into a message: control characters (line ends among them) as
/// spaces, and not without end, so that the message stays one line.
std::string ShownLine(std::string_view text);

/// Text of a user's file: the same in quotes, cut shorter.
std::string ShownText(std::string_view text);

}  // namespace finray

#endif  // FINRAY_IO_SHOWN_TEXT_H_
