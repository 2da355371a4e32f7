#ifndef FINRAY_CALIB_REPORT_YAML_ROWS_H_
#define FINRAY_CALIB_REPORT_YAML_ROWS_H_

#include <string>
#include <vector>

#include "finray/calib/analysis/gate.h"
#include "finray/io/sha256.h"
#include "finray/io/yaml_emitter.h"

namespace finray {

/// Emits a key and begins its mapping.
inline void BeginMap(YamlEmitter* yaml, const char* key) {
  *yaml << YAML::Key << key << YAML::Value << YAML::BeginMap;
}

/// The same for a mapping on one line.
inline void BeginLine(YamlEmitter* yaml, const char* key) {
  *yaml << YAML::Key << key << YAML::Value << YAML::Flow << YAML::BeginMap;
}

/// Emits a key and its mapping of alternating keys and values, on one line.
template <class... Pairs>
void EmitLine(YamlEmitter* yaml, const char* key, const Pairs&... pairs) {
  BeginLine(yaml, key);
  YamlPairs(yaml, pairs...);
  *yaml << YAML::EndMap;
}

/// Emits a key and a sequence. `emit(element)` emits each element.
template <class Elements, class Emit>
void EmitSeq(YamlEmitter* yaml, const char* key, const Elements& elements,
             const Emit& emit) {
  *yaml << YAML::Key << key << YAML::Value << YAML::BeginSeq;
  for (const auto& element : elements) emit(element);
  *yaml << YAML::EndSeq;
}

/// Emits {path, sha256}, with or without a key.
inline void EmitFile(YamlEmitter* yaml, const std::string& path) {
  YamlLine(yaml, "path", path, "sha256", Sha256OfFile(path));
}
inline void EmitFile(YamlEmitter* yaml, const char* key,
                     const std::string& path) {
  EmitLine(yaml, key, "path", path, "sha256", Sha256OfFile(path));
}

/// Emits the verdict over all gates.
inline void EmitVerdict(YamlEmitter* yaml, const std::vector<Gate>& gates) {
  YamlPair(yaml, "verdict",
           gates.empty()      ? "no_gates"
           : AllPassed(gates) ? "passed"
                              : "failed");
}

inline void EmitGates(YamlEmitter* yaml, const std::vector<Gate>& gates) {
  EmitSeq(yaml, "gates", gates, [&](const Gate& gate) {
    *yaml << YAML::Flow << YAML::BeginMap;
    YamlPairs(yaml, "name", gate.name, "bound", gate.bound, "value", gate.value,
              "passed", gate.passed);
    if (gate.range) {
      YamlPairs(yaml, "low", gate.range->first, "high", gate.range->second);
    }
    *yaml << YAML::EndMap;
  });
}

}  // namespace finray

#endif  // FINRAY_CALIB_REPORT_YAML_ROWS_H_
