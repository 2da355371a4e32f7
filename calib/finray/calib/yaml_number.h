#ifndef FINRAY_CALIB_YAML_NUMBER_H_
#define FINRAY_CALIB_YAML_NUMBER_H_

#include <yaml-cpp/yaml.h>

#include <cmath>
#include <string>

#include "finray/io/atomic_file.h"

namespace finray {

/// A number that reads back as the same double, as YAML has it: .nan, .inf, and
/// with a point before an exponent, without which YAML 1.1 takes it for text.
inline std::string YamlNumber(double value) {
  if (std::isnan(value)) return ".nan";
  if (std::isinf(value)) return value > 0 ? ".inf" : "-.inf";
  std::string text = NumberText(value);
  const std::size_t exponent = text.find('e');
  if (exponent != std::string::npos && text.find('.') == std::string::npos) {
    text.insert(exponent, ".0");
  }
  return text;
}

/// A key and its value in a mapping that has been begun.
template <class Key, class Value>
void YamlPair(YAML::Emitter* yaml, const Key& key, const Value& value) {
  *yaml << YAML::Key << key << YAML::Value << value;
}

}  // namespace finray

#endif  // FINRAY_CALIB_YAML_NUMBER_H_
