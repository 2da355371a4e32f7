#ifndef FINRAY_BENCHMARK_JSON_EMITTER_H_
#define FINRAY_BENCHMARK_JSON_EMITTER_H_

#include <cmath>

#include "finray/io/yaml_emitter.h"

namespace finray {

/// Writes JSON, which is YAML in flow style with keys and texts in double
/// quotes.
class JsonEmitter : public YamlEmitter {
 public:
  JsonEmitter() {
    SetMapFormat(YAML::Flow);
    SetSeqFormat(YAML::Flow);
    SetStringFormat(YAML::DoubleQuoted);
    SetOutputCharset(YAML::EscapeAsJson);
  }

  /// Writes keys and values of a mapping, in turn. Numbers that are not finite
  /// are left out, as JSON has none.
  template <class Value, class... More>
  void Pairs(const char* key, const Value& value, const More&... more) {
    bool known = true;
    if constexpr (std::is_floating_point_v<Value>) known = std::isfinite(value);
    if (known) YamlPair(this, key, value);
    if constexpr (sizeof...(more) > 0) Pairs(more...);
  }

  /// Writes a sequence of mappings, each on a line; `write` fills the mapping
  /// of one item.
  template <class Items, class Write>
  void Maps(const char* key, const Items& items, Write write) {
    // Before the key: at an end it leaves a comma.
    *this << YAML::Newline << YAML::Key << key << YAML::Value << YAML::BeginSeq;
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
