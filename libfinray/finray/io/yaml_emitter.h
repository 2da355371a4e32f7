#ifndef FINRAY_IO_YAML_EMITTER_H_
#define FINRAY_IO_YAML_EMITTER_H_

#include <yaml-cpp/yaml.h>

#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "finray/io/number_text.h"
#include "finray/io/utf8.h"

namespace finray {

/// A YAML::Emitter that writes numbers the same way in every locale. yaml-cpp
/// follows the locale: in a German one it writes "1,5", and "2.577" for 2577.
/// Texts are UTF-8 whatever they hold (AsUtf8).
class YamlEmitter : public YAML::Emitter {
 public:
  /// `digits` is that of YamlNumber.
  explicit YamlEmitter(int digits = 0) : digits_(digits) {}
  int digits() const { return digits_; }

 private:
  int digits_;
};

// Numbers have no quotes, whatever texts have.
template <class T>
YamlEmitter& operator<<(YamlEmitter& yaml, const T& value) {
  YAML::Emitter& base = yaml;
  if constexpr (std::is_floating_point_v<T>) {
    base << YAML::Auto << YamlNumber(value, yaml.digits());
  } else if constexpr (std::is_integral_v<T> && !std::is_same_v<T, bool> &&
                       !std::is_same_v<T, char>) {
    base << YAML::Auto << std::to_string(value);
  } else if constexpr (std::is_convertible_v<const T&, std::string_view>) {
    base << AsUtf8(value);
  } else {
    base << value;
  }
  return yaml;
}

template <class T>
YamlEmitter& operator<<(YamlEmitter& yaml, const std::vector<T>& values) {
  yaml << YAML::BeginSeq;
  for (const T& value : values) yaml << value;
  return yaml << YAML::EndSeq;
}

/// Writes a key and its value into an open mapping.
template <class Key, class Value>
void YamlPair(YamlEmitter* yaml, const Key& key, const Value& value) {
  *yaml << YAML::Key << key << YAML::Value << value;
}

/// Writes several keys and values into an open mapping. They alternate.
template <class Key, class Value, class... More>
void YamlPairs(YamlEmitter* yaml, const Key& key, const Value& value,
               const More&... more) {
  YamlPair(yaml, key, value);
  if constexpr (sizeof...(more) > 0) YamlPairs(yaml, more...);
}

/// Writes a mapping of alternating keys and values on one line.
template <class... Pairs>
void YamlLine(YamlEmitter* yaml, const Pairs&... pairs) {
  *yaml << YAML::Flow << YAML::BeginMap;
  YamlPairs(yaml, pairs...);
  *yaml << YAML::EndMap;
}

}  // namespace finray

#endif  // FINRAY_IO_YAML_EMITTER_H_
