#ifndef FINRAY_IO_MESSAGE_TEXT_H_
#define FINRAY_IO_MESSAGE_TEXT_H_

#include <string>
#include <string_view>
#include <vector>

namespace finray {

/// Returns text as one line of UTF-8. Control characters and line ends become
/// spaces, and bytes that are not UTF-8 question marks.
std::string OneLine(std::string_view text);

/// The same for a message: text beyond 1000 bytes is cut off.
std::string ShownLine(std::string_view text);

/// Returns text from a user's file for a message: in quotes, and cut after 40
/// bytes.
std::string ShownText(std::string_view text);

/// The words in a row, with `separator` between them.
std::string Joined(const std::vector<std::string>& words,
                   const char* separator = ", ");

/// Returns " (did you mean 'x'?)" with the candidate x nearest to `name` by
/// edit distance (case-insensitive), or "" if none is near enough.
std::string DidYouMean(const std::string& name,
                       const std::vector<std::string>& candidates);

}  // namespace finray

#endif  // FINRAY_IO_MESSAGE_TEXT_H_
