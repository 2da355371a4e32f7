#include "finray/io/number_text.h"

#include <charconv>
#include <cmath>
#include <cstdarg>
#include <cstdio>

namespace finray {

std::optional<double> ParseNumber(std::string_view text) {
  // from_chars accepts no plus sign; "+-5" must not pass either.
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

std::string NumberText(double value) {
  if (std::isnan(value)) return "nan";
  if (std::isinf(value)) return value > 0 ? "inf" : "-inf";
  char text[32];
  const auto end = std::to_chars(text, text + sizeof text, value).ptr;
  return std::string(text, end);
}

std::string YamlNumber(double value, int digits) {
  if (std::isnan(value)) return ".nan";
  if (std::isinf(value)) return value > 0 ? ".inf" : "-.inf";
  std::string text =
      digits > 0 ? FormatText("%.*g", digits, value) : NumberText(value);
  const std::size_t exponent = text.find('e');
  if (exponent != std::string::npos && text.find('.') == std::string::npos) {
    text.insert(exponent, ".0");
  }
  return text;
}

std::string FormatText(const char* format, ...) {
  const ClassicNumbers classic;
  std::string text;
  // The first pass finds the length.
  for (int pass = 0; pass < 2; ++pass) {
    va_list values;
    va_start(values, format);
    const int length =
        std::vsnprintf(text.data(), text.size() + 1, format, values);
    va_end(values);
    if (pass == 0 && length > 0) text.resize(static_cast<std::size_t>(length));
  }
  return text;
}

ClassicNumbers::ClassicNumbers() {
  static const locale_t classic = newlocale(LC_ALL_MASK, "C", nullptr);
  before_ = uselocale(classic);
}

}  // namespace finray
