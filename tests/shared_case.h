#ifndef FINRAY_TESTS_SHARED_CASE_H_
#define FINRAY_TESTS_SHARED_CASE_H_

#include <filesystem>
#include <string>

namespace finray {

/// Returns the path of inputs kept beside the source tree; empty where they
/// are not there.
inline std::string SharedCase(const std::string& name) {
  const std::string path = FINRAY_SOURCE_DIR "/../shared/cases/" + name;
  return std::filesystem::exists(path) ? path : "";
}

}  // namespace finray

#endif  // FINRAY_TESTS_SHARED_CASE_H_
