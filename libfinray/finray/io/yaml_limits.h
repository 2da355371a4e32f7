#ifndef FINRAY_IO_YAML_LIMITS_H_
#define FINRAY_IO_YAML_LIMITS_H_

#include <yaml-cpp/mark.h>

#include <cstddef>
#include <string>

namespace finray {

// The limits of YAML files. A few bytes of YAML can stand for any amount of
// data by nested lists or aliases of aliases ("billion laughs"). So a file is
// first checked event by event, which takes no memory, and then built as a
// tree.

constexpr int kMostYaml_MiB = 16;
/// Values and keys; those behind an alias count each time.
constexpr std::size_t kMostYamlNodes = 1000000;
constexpr std::size_t kMostYamlDepth = 50;

/// Throws InputError (path:line:column) for text that is no YAML, is beyond
/// these limits, or has an alias inside the value that it refers to.
void CheckYamlLimits(const std::string& path, const std::string& text);

/// "path:line:column: ", which begins a message; line and column count from 0.
std::string YamlPlace(const std::string& path, int line, int column);
std::string YamlPlace(const std::string& path, const YAML::Mark& mark);

}  // namespace finray

#endif  // FINRAY_IO_YAML_LIMITS_H_
