#ifndef FINRAY_IO_YAML_PLACE_H_
#define FINRAY_IO_YAML_PLACE_H_

#include <yaml-cpp/mark.h>

#include <string>

namespace finray {

/// How a message about a place of a file begins; line and column from 0.
inline std::string YamlPlace(const std::string& path, int line, int column) {
  return path + ":" + std::to_string(line + 1) + ":" +
         std::to_string(column + 1) + ": ";
}

inline std::string YamlPlace(const std::string& path, const YAML::Mark& mark) {
  return mark.is_null() ? path + ": " : YamlPlace(path, mark.line, mark.column);
}

}  // namespace finray

#endif  // FINRAY_IO_YAML_PLACE_H_
