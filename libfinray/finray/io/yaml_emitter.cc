#include "finray/io/yaml_emitter.h"

#include <cmath>

#include "finray/io/number_text.h"

namespace finray {

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

}  // namespace finray
