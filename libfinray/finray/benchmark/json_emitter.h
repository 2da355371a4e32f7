#ifndef FINRAY_BENCHMARK_JSON_EMITTER_H_
#define FINRAY_BENCHMARK_JSON_EMITTER_H_

#include <cmath>
#include <string>
#include <vector>

#include "finray/io/yaml_emitter.h"

namespace finray {

/// Writes JSON, which is YAML in flow style with keys and texts in double
/// quotes. Strings go through Value, for the quotes; all else is as with
/// YamlEmitter.
class JsonEmitter : public YamlEmitter {
 public:
  JsonEmitter() {
    SetMapFormat(YAML::Flow);
    SetSeqFormat(YAML::Flow);
    SetOutputCharset(YAML::EscapeAsJson);
  }

  void Key(const char* key) {
    *this << YAML::Key << YAML::DoubleQuoted << key << YAML::Value;
  }
  void Value(const std::string& text) { *this << YAML::DoubleQuoted << text; }
  void Value(const char* text) { *this << YAML::DoubleQuoted << text; }
  void Value(const std::vector<std::string>& texts) {
    *this << YAML::BeginSeq;
    for (const std::string& text : texts) Value(text);
    *this << YAML::EndSeq;
  }
  template <class T>
  void Value(const T& value) {
    *this << value;
  }

  /// Writes a pair of a mapping. Numbers that are not finite are left out, as
  /// JSON has none.
  template <class T>
  void Pair(const char* key, const T& value) {
    if constexpr (std::is_floating_point_v<T>) {
      if (!std::isfinite(value)) return;
    }
    Key(key);
    Value(value);
  }

  /// Writes a sequence of mappings, each on a line; `write` fills the mapping
  /// of one item.
  template <class Items, class Write>
  void Maps(const char* key, const Items& items, Write write) {
    *this << YAML::Newline;  // before the key: at an end it leaves a comma
    Key(key);
    *this << YAML::BeginSeq;
    for (const auto& item : items) {
      *this << YAML::Newline << YAML::BeginMap;
      write(item);
      *this << YAML::EndMap;
    }
    *this << YAML::EndSeq;
  }
};

}  // namespace finray

#endif  // FINRAY_BENCHMARK_JSON_EMITTER_H_
