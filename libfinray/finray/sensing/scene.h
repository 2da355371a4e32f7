#ifndef FINRAY_SENSING_SCENE_H_
#define FINRAY_SENSING_SCENE_H_

#include <map>
#include <optional>
#include <string>

#include "finray/io/yaml_map.h"

namespace finray {

/// What a scene contains, hence what is modelled.
struct Scene {
  /// Number of contacts; empty: decided frame by frame ("auto").
  std::optional<int> contacts;
  double friction_coefficient = 0;  ///< mu; + pulls the finger to its tip.
  std::optional<double> circle_radius_mm;  ///< of the object, if there is one.
  /// A lab's own headers for columns of the frame table.
  std::map<std::string, std::string> columns;
};

/// Reads a scene YAML. Throws InputError for unknown keys and for what is not
/// modelled.
Scene ReadScene(const std::string& path);
Scene ReadScene(const YamlMap& yaml);

/// The `columns:` mapping of a YAML, empty if there is none.
std::map<std::string, std::string> ReadColumns(const YamlMap& yaml);

}  // namespace finray

#endif  // FINRAY_SENSING_SCENE_H_
