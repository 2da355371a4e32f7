#include "finray/io/shown_text.h"

namespace finray {

std::string ShownLine(std::string_view text) {
  constexpr std::size_t kLongest = 1000;
  std::string shown(text.substr(0, kLongest));
  for (char& c : shown) {
    if (static_cast<unsigned char>(c) < ' ' || c == '\x7f') c = ' ';
  }
  if (text.size() > kLongest) shown += "...";
  return shown;
}

std::string ShownText(std::string_view text) {
  constexpr std::size_t kLongest = 40;
  const bool cut = text.size() > kLongest;
  return "'" + ShownLine(text.substr(0, kLongest)) + (cut ? "..." : "") + "'";
}

}  // namespace finray
