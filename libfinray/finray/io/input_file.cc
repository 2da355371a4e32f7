#include "finray/io/input_file.h"

#include <filesystem>

#include "finray/io/error.h"

namespace finray {

void RefuseFolderOrPipe(const std::string& path, const std::string& expected) {
  std::error_code unknown;
  const std::filesystem::file_status status =
      std::filesystem::status(path, unknown);
  if (std::filesystem::is_directory(status)) {
    throw InputError(path + ": is a folder, expected " + expected);
  }
  if (std::filesystem::is_fifo(status)) {
    throw InputError(path + ": is a pipe, expected " + expected +
                     "; inputs are read more than once");
  }
}

}  // namespace finray
