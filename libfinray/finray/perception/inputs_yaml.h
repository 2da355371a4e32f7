#ifndef FINRAY_PERCEPTION_INPUTS_YAML_H_
#define FINRAY_PERCEPTION_INPUTS_YAML_H_

#include <string>
#include <vector>

#include "finray/io/sha256.h"
#include "finray/io/yaml_emitter.h"

namespace finray {

/// Writes the keys `inputs`, the files that a result was made from with their
/// hashes, and `version` to a mapping that has been begun.
inline void EmitInputs(const std::vector<std::string>& paths,
                       YamlEmitter* yaml) {
  *yaml << YAML::Key << "inputs" << YAML::Value << YAML::BeginSeq;
  for (const std::string& path : paths) {
    YamlLine(yaml, "path", path, "sha256", Sha256OfFile(path));
  }
  *yaml << YAML::EndSeq;
  YamlPair(yaml, "version", FINRAY_VERSION);
}

}  // namespace finray

#endif  // FINRAY_PERCEPTION_INPUTS_YAML_H_
