#include "finray/io/utf8.h"

#include <cctype>

#include "finray/io/number_text.h"

namespace finray {
namespace {

// Says whether every reader of YAML takes a character as a part of one line:
// not DEL, the controls U+0080 to U+009F, U+2028, U+2029, U+FFFE and U+FFFF.
bool IsPlain(std::string_view character) {
  return character != "\x7f" &&
         (character.substr(0, 1) != "\xc2" || character > "\xc2\x9f") &&
         character != "\xe2\x80\xa8" && character != "\xe2\x80\xa9" &&
         character != "\xef\xbf\xbe" && character != "\xef\xbf\xbf";
}

void AppendPercent(std::string_view bytes, std::string* text) {
  for (const char c : bytes) {
    *text += FormatText("%%%02X", static_cast<unsigned char>(c));
  }
}

}  // namespace

std::size_t Utf8Bytes(std::string_view text) {
  const auto byte = [&](std::size_t i) {
    return static_cast<unsigned char>(text[i]);
  };
  const unsigned char first = byte(0);
  if (first < 0x80) return 1;
  const std::size_t bytes = first >= 0xC2 && first < 0xE0   ? 2
                            : first >= 0xE0 && first < 0xF0 ? 3
                            : first >= 0xF0 && first < 0xF5 ? 4
                                                            : 0;
  if (bytes == 0 || text.size() < bytes) return 0;
  for (std::size_t i = 1; i < bytes; ++i) {
    if ((byte(i) & 0xC0) != 0x80) return 0;
  }
  // Overlong forms, surrogates and what is beyond U+10FFFF.
  if ((first == 0xE0 && byte(1) < 0xA0) || (first == 0xED && byte(1) > 0x9F) ||
      (first == 0xF0 && byte(1) < 0x90) || (first == 0xF4 && byte(1) > 0x8F)) {
    return 0;
  }
  return bytes;
}

std::string AsUtf8(std::string_view bytes) {
  std::string text;
  bool changed = false;
  for (std::string_view rest = bytes; !rest.empty();) {
    const std::size_t count = Utf8Bytes(rest);
    const std::string_view character = rest.substr(0, count == 0 ? 1 : count);
    if (count == 0 || !IsPlain(character)) {
      AppendPercent(character, &text);
      changed = true;
    } else if (character == "%") {
      AppendPercent(character, &text);
    } else {
      text += character;
    }
    rest.remove_prefix(character.size());
  }
  return changed ? text : std::string(bytes);
}

std::string WithoutPercents(std::string_view text) {
  std::string bytes;
  const auto digit = [&](std::size_t i) {
    const int c = std::toupper(static_cast<unsigned char>(text[i]));
    return std::isdigit(c) != 0 ? c - '0' : c - 'A' + 10;
  };
  const auto is_digit = [&](std::size_t i) {
    return i < text.size() &&
           std::isxdigit(static_cast<unsigned char>(text[i])) != 0;
  };
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '%' && is_digit(i + 1) && is_digit(i + 2)) {
      bytes += static_cast<char>(16 * digit(i + 1) + digit(i + 2));
      i += 2;
    } else {
      bytes += text[i];
    }
  }
  return bytes;
}

}  // namespace finray
