#ifndef FINRAY_IO_SHOWN_TEXT_H_
#define FINRAY_IO_SHOWN_TEXT_H_

#include <string>
#include <string_view>

namespace finray {

/// Text of a user's file as it goes into a message: in quotes, cut short,
/// control characters (line ends among them) as spaces, so that the message
/// stays one line.
std::string ShownText(std::string_view text);

}  // namespace finray

#endif  // FINRAY_IO_SHOWN_TEXT_H_
