#include "finray/io/atomic_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include "finray/io/error.h"

namespace finray {
namespace {

namespace fs = std::filesystem;

// These return 0 or what went wrong as an errno value.

int WriteAll(int file, const std::string& content) {
  std::size_t done = 0;
  while (done < content.size()) {
    const ssize_t n = write(file, content.data() + done, content.size() - done);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return errno;
    done += static_cast<std::size_t>(n);
  }
  return 0;
}

int WriteThrough(const fs::path& path, const std::string& content) {
  const int file = open(path.c_str(), O_WRONLY | O_CLOEXEC);
  if (file < 0) return errno;
  const int error = WriteAll(file, content);
  return close(file) != 0 && error == 0 ? errno : error;
}

// A new file in the folder. Not mkstemp, whose files only their owner may read.
int CreateTemporary(const fs::path& folder, fs::path* path, int* file) {
  static std::atomic<unsigned> counter{0};
  do {
    *path = folder / (".finray-" + std::to_string(getpid()) + "-" +
                      std::to_string(counter++) + ".tmp");
    *file = open(path->c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  } while (*file < 0 && errno == EEXIST);
  return *file < 0 ? errno : 0;
}

int WriteAndRename(const fs::path& path, const std::string& content) {
  fs::path temporary;
  int file = -1;
  int error = CreateTemporary(path.parent_path(), &temporary, &file);
  if (error != 0) return error;
  error = WriteAll(file, content);
  // A full disk may show only now.
  if (error == 0 && fsync(file) != 0) error = errno;
  if (close(file) != 0 && error == 0) error = errno;
  if (error == 0 && std::rename(temporary.c_str(), path.c_str()) != 0) {
    error = errno;
  }
  if (error != 0) unlink(temporary.c_str());
  return error;
}

int WriteFile(const std::string& path, const std::string& content) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (fs::is_directory(status)) return EISDIR;
  if (!fs::exists(status)) return WriteAndRename(path, content);
  if (!fs::is_regular_file(status)) return WriteThrough(path, content);
  const fs::path target = fs::canonical(path, error);
  return error ? error.value() : WriteAndRename(target, content);
}

}  // namespace

void WriteFileAtomically(const std::string& path, const std::string& content) {
  const int error = WriteFile(path, content);
  if (error != 0) {
    throw InputError(path + ": cannot be written: " + std::strerror(error));
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
