#ifndef FINRAY_CALIB_REPORT_YAML_ROWS_H_
#define FINRAY_CALIB_REPORT_YAML_ROWS_H_

#include <string>
#include <vector>

#include "finray/io/sha256.h"
#include "finray/io/yaml_emitter.h"

namespace finray {

/// Emits a key and begins its mapping.
inline void BeginMap(YamlEmitter* yaml, const char* key) {
  *yaml << YAML::Key << key << YAML::Value << YAML::BeginMap;
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
  *yaml << YAML::Key << key << YAML::Value;
  EmitFile(yaml, path);
}

/// Emits the verdict over gates, each with a `passed`.
template <class Gates>
void EmitVerdict(YamlEmitter* yaml, const Gates& gates) {
  bool passed = true;
  for (const auto& gate : gates) passed &= gate.passed;
  YamlPair(yaml, "verdict",
           gates.empty() ? "no_gates"
           : passed      ? "passed"
                         : "failed");
}

}  // namespace finray

#endif  // FINRAY_CALIB_REPORT_YAML_ROWS_H_
