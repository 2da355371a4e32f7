#include "finray/io/resources.h"

#include <dlfcn.h>
#include <link.h>

#include <filesystem>

#include "finray/io/error.h"

namespace finray {
namespace {

namespace fs = std::filesystem;

// The file with this code, without symbolic links.
fs::path ThisBinary() {
  Dl_info info;
  link_map* map = nullptr;
  std::error_code unknown;
  // The map has no name for the executable.
  if (dladdr1(reinterpret_cast<void*>(&ResourcePath), &info,
              reinterpret_cast<void**>(&map), RTLD_DL_LINKMAP) != 0 &&
      map != nullptr && map->l_name[0] != '\0') {
    return fs::canonical(map->l_name, unknown);
  }
  return fs::read_symlink("/proc/self/exe", unknown);
}

}  // namespace

std::string ResourcePath(const std::string& name) {
  const fs::path folder = ThisBinary().parent_path();
  for (const char* up : {"share", "../share", "../../share"}) {
    const fs::path path = folder / up / "finray" / name;
    std::error_code missing;
    if (fs::exists(path, missing)) return path.lexically_normal().string();
  }
  throw InputError(name + ": is missing; expected it in share/finray beside " +
                   folder.string() + ". Install finray as a whole");
}

}  // namespace finray
