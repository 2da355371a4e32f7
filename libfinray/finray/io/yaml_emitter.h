#ifndef FINRAY_IO_YAML_EMITTER_H_
#define FINRAY_IO_YAML_EMITTER_H_

#include <yaml-cpp/yaml.h>

#include <string>
#include <type_traits>
#include <vector>

namespace finray {

/// A number that reads back as the same double, as YAML has it: .nan, .inf, and
/// with a point before an exponent, without which YAML 1.1 takes it for text.
/// With `digits` it is rounded to as many (0.1 + 0.2 is 0.3 with 12).
std::string YamlNumber(double value, int digits = 0);

/// yaml-cpp writes numbers as the locale has them, "1,5" and "2.577" for 2577
/// where a host program has taken on a German one. This one does not.
class YamlEmitter : public YAML::Emitter {
 public:
  /// `digits` as of YamlNumber.
  explicit YamlEmitter(int digits = 0) : digits_(digits) {}
  int digits() const { return digits_; }

 private:
  int digits_;
};

template <class T>
YamlEmitter& operator<<(YamlEmitter& yaml, const T& value) {
  YAML::Emitter& base = yaml;
  if constexpr (std::is_floating_point_v<T>) {
    base << YamlNumber(value, yaml.digits());
  } else if constexpr (std::is_integral_v<T> && !std::is_same_v<T, bool> &&
                       !std::is_same_v<T, char>) {
    base << std::to_string(value);
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

/// A key and its value in a mapping that has been begun.
template <class Key, class Value>
void YamlPair(YamlEmitter* yaml, const Key& key, const Value& value) {
  *yaml << YAML::Key << key << YAML::Value << value;
}

}  // namespace finray

#endif  // FINRAY_IO_YAML_EMITTER_H_
