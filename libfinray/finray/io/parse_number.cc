#include "finray/io/parse_number.h"

#include <charconv>
#include <cmath>

namespace finray {

std::optional<double> ParseNumber(std::string_view text) {
  // from_chars knows no plus sign; "+-5" must not slip through with it.
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') {
    text.remove_prefix(1);
  }
  const char* end = text.data() + text.size();
  double value;
  const auto result = std::from_chars(text.data(), end, value);
  if (result.ec != std::errc() || result.ptr != end || !std::isfinite(value)) {
    return std::nullopt;
  }
  return value;
}

}  // namespace finray
