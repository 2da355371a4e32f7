#include "finray/io/yaml_emitter.h"

#include <charconv>
#include <cmath>

#include "finray/io/number_text.h"

namespace finray {

std::string YamlNumber(double value, int digits) {
  if (std::isnan(value)) return ".nan";
  if (std::isinf(value)) return value > 0 ? ".inf" : "-.inf";
  std::string text = NumberText(value);
  if (digits > 0) {
    char rounded[64];
    text.assign(rounded, std::to_chars(rounded, rounded + sizeof rounded, value,
                                       std::chars_format::general, digits)
                             .ptr);
  }
  const std::size_t exponent = text.find('e');
  if (exponent != std::string::npos && text.find('.') == std::string::npos) {
    text.insert(exponent, ".0");
  }
  return text;
}

}  // namespace finray
