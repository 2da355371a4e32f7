#include "finray/view/json_text.h"

#include <cmath>
#include <cstdint>

#include "finray/io/number_text.h"
#include "finray/io/utf8.h"

namespace finray {

std::string JsonText(std::string_view text) {
  std::string json = "\"";
  while (!text.empty()) {
    const std::size_t bytes = Utf8Bytes(text);
    const auto first = static_cast<unsigned char>(text[0]);
    if (bytes == 0) {
      json += '?';
    } else if (first < 0x20 || first == '<' || first == '"' || first == '\\') {
      json += FormatText("\\u%04x", first);
    } else {
      json += text.substr(0, bytes);
    }
    text.remove_prefix(bytes == 0 ? 1 : bytes);
  }
  return json + '"';
}

std::string JsonNumber(double value) {
  return std::isfinite(value) ? NumberText(value) : "null";
}

std::string JsonNumbers(const std::vector<double>& values) {
  JsonArray array;
  for (const double value : values) array.Add(JsonNumber(value));
  return array.str();
}

JsonObject& JsonObject::Add(std::string_view name, std::string_view json) {
  if (text_.size() > 1) text_ += ',';
  text_ += JsonText(name);
  text_ += ':';
  text_ += json;
  return *this;
}

JsonArray& JsonArray::Add(std::string_view json) {
  if (text_.size() > 1) text_ += ',';
  text_ += json;
  return *this;
}

std::string Base64(std::string_view bytes) {
  constexpr char kDigits[] =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t word = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t at = i + k;
      word = word << 8 |
             (at < bytes.size() ? static_cast<unsigned char>(bytes[at]) : 0u);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      text += i + k <= bytes.size() ? kDigits[word >> (18 - 6 * k) & 63] : '=';
    }
  }
  return text;
}

}  // namespace finray
