#include <filesystem>

#include "app.h"

DECLARE_string(out_dir);

namespace finray {

std::string OutPath(const std::string& name) {
  return (std::filesystem::path(FLAGS_out_dir) / name).string();
}

}  // namespace finray
