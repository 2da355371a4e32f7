#ifndef FINRAY_PERCEPTION_INPUTS_YAML_H_
#define FINRAY_PERCEPTION_INPUTS_YAML_H_

#include <string>
#include <vector>

#include "finray/io/sha256.h"
#include "finray/io/yaml_emitter.h"

namespace finray {

/// The files that a result was made from, with their hashes, and the version:
/// the last keys of a mapping that has been begun.
inline void EmitInputs(const std::vector<std::string>& paths,
                       YamlEmitter* yaml) {
  *yaml << YAML::Key << "inputs" << YAML::Value << YAML::BeginSeq;
  for (const std::string& path : paths) {
    *yaml << YAML::Flow << YAML::BeginMap << YAML::Key << "path" << YAML::Value
          << path << YAML::Key << "sha256" << YAML::Value << Sha256OfFile(path)
          << YAML::EndMap;
  }
  *yaml << YAML::EndSeq << YAML::Key << "version" << YAML::Value
        << FINRAY_VERSION;
}

}  // namespace finray

#endif  // FINRAY_PERCEPTION_INPUTS_YAML_H_
