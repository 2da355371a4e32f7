#include "finray/io/input_file.h"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

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

std::string ReadWholeFile(const std::string& path, const std::string& expected,
                          int most_MiB) {
  RefuseFolderOrPipe(path, expected);
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  std::string bytes;
  char buffer[1 << 14];
  while (file.read(buffer, sizeof buffer), file.gcount() > 0) {
    bytes.append(buffer, static_cast<std::size_t>(file.gcount()));
    if (bytes.size() > static_cast<std::size_t>(most_MiB) << 20) {
      throw InputError(path + ": is too long, expected " + expected +
                       " of at most " + std::to_string(most_MiB) + " MiB");
    }
  }
  if (!file.is_open() || file.bad()) {
    throw InputError(path + ": cannot be read: " + std::strerror(errno));
  }
  return bytes;
}

}  // namespace finray
