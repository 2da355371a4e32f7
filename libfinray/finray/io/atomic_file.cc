#include "finray/io/atomic_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include "finray/io/error.h"

namespace finray {
namespace {

bool WriteAll(int file, const std::string& content) {
  std::size_t done = 0;
  while (done < content.size()) {
    const ssize_t n = write(file, content.data() + done, content.size() - done);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return false;
    done += static_cast<std::size_t>(n);
  }
  return fsync(file) == 0;
}

}  // namespace

void WriteFileAtomically(const std::string& path, const std::string& content) {
  const auto fail = [&path](int error) {
    throw InputError(path + ": cannot be written: " + std::strerror(error));
  };
  if (std::filesystem::is_directory(path)) fail(EISDIR);
  std::string temporary = path + ".XXXXXX";
  const int file = mkstemp(temporary.data());
  if (file < 0) fail(errno);
  // mkstemp makes it private; give it what the umask would have.
  const mode_t mask = umask(0);
  umask(mask);
  const bool written =
      fchmod(file, 0666 & ~mask) == 0 && WriteAll(file, content);
  int error = written ? 0 : errno;
  if (close(file) != 0 && error == 0) error = errno;
  if (error == 0 && std::rename(temporary.c_str(), path.c_str()) != 0) {
    error = errno;
  }
  if (error != 0) {
    unlink(temporary.c_str());
    fail(error);
  }
}

void MakeFolder(const std::string& path) {
  std::error_code error;
  std::filesystem::create_directories(path, error);
  if (error || !std::filesystem::is_directory(path)) {
    throw InputError(path + ": cannot be made a folder: " +
                     (error ? error.message() : "a file has that name"));
  }
}

std::string NumberText(double value) {
  if (std::isnan(value)) return "nan";
  if (std::isinf(value)) return value > 0 ? "inf" : "-inf";
  char text[32];
  const auto end = std::to_chars(text, text + sizeof text, value).ptr;
  return std::string(text, end);
}

}  // namespace finray
