#include "finray/io/number_text.h"

#include <locale.h>  // uselocale is not in <clocale>

#include <charconv>
#include <cmath>
#include <cstdarg>
#include <cstdio>

namespace finray {

std::string NumberText(double value) {
  if (std::isnan(value)) return "nan";
  if (std::isinf(value)) return value > 0 ? "inf" : "-inf";
  char text[32];
  const auto end = std::to_chars(text, text + sizeof text, value).ptr;
  return std::string(text, end);
}

std::string FormatText(const char* format, ...) {
  // Of this thread alone.
  static const locale_t classic = newlocale(LC_ALL_MASK, "C", nullptr);
  const locale_t before = uselocale(classic);
  va_list values, again;
  va_start(values, format);
  va_copy(again, values);
  std::string text(
      static_cast<std::size_t>(std::vsnprintf(nullptr, 0, format, values)),
      '\0');
  std::vsnprintf(text.data(), text.size() + 1, format, again);
  va_end(again);
  va_end(values);
  uselocale(before);
  return text;
}

}  // namespace finray
