#ifndef FINRAY_IO_YAML_LIMITS_H_
#define FINRAY_IO_YAML_LIMITS_H_

#include <cstddef>
#include <string>

namespace finray {

// A few bytes of YAML can stand for any amount of data: nested lists, or
// aliases of aliases ("billion laughs"). Files are therefore gone through event
// by event, which takes no memory, before they are built as a tree.

constexpr std::size_t kMostYamlBytes = 16 << 20;
/// Values and keys, those behind an alias counted each time.
constexpr std::size_t kMostYamlNodes = 1000000;
constexpr std::size_t kMostYamlDepth = 50;

/// Of numbers. What has to be above 0 is not below one over this either, so
/// that products and ratios of a few numbers neither overflow nor vanish.
constexpr double kLargestYamlNumber = 1e30;

/// Throws InputError (path:line:column) for text that is no YAML, is beyond
/// these limits, or refers to what it is inside.
void CheckYamlLimits(const std::string& path, const std::string& text);

}  // namespace finray

#endif  // FINRAY_IO_YAML_LIMITS_H_
