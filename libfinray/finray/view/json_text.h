#ifndef FINRAY_VIEW_JSON_TEXT_H_
#define FINRAY_VIEW_JSON_TEXT_H_

#include <string>
#include <string_view>
#include <vector>

namespace finray {

// Values as JSON that is safe inside a <script> element of a page.

/// Returns a string in quotes. '<' is escaped, so that no "</script>" of a
/// user's file ends the element; bytes that are not UTF-8 become '?'.
std::string JsonText(std::string_view text);
/// Returns a number; null if it is not finite.
std::string JsonNumber(double value);
std::string JsonNumbers(const std::vector<double>& values);

/// Appends members to an object, one by one.
class JsonObject {
 public:
  /// `json` is a value in JSON.
  JsonObject& Add(std::string_view name, std::string_view json);
  std::string str() const { return text_ + "}"; }

 private:
  std::string text_ = "{";
};

/// Appends elements to an array, one by one.
class JsonArray {
 public:
  JsonArray& Add(std::string_view json);
  std::string str() const { return text_ + "]"; }

 private:
  std::string text_ = "[";
};

/// Returns the bytes in base64.
std::string Base64(std::string_view bytes);

}  // namespace finray

#endif  // FINRAY_VIEW_JSON_TEXT_H_
