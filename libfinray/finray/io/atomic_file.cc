#include "finray/io/atomic_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "finray/io/error.h"

namespace finray {
namespace {

namespace fs = std::filesystem;

// These functions return 0 or an errno value.

int WriteThrough(const fs::path& path, const std::string& content) {
  FileDescriptor file;
  int error = file.Open(path, O_WRONLY);
  if (error != 0) return error;
  error = file.Write(content);
  const int close_error = file.Close();
  return error != 0 ? error : close_error;
}

int WriteAndRename(const fs::path& path, const std::string& content) {
  static std::atomic<unsigned> counter{0};
  fs::path temporary;
  FileDescriptor file;
  int error = 0;
  do {  // mkstemp would let only the owner read it
    temporary = path.parent_path() / (".finray-" + std::to_string(getpid()) +
                                      "-" + std::to_string(counter++) + ".tmp");
    error = file.Open(temporary, O_WRONLY | O_CREAT | O_EXCL);
  } while (error == EEXIST);
  if (error != 0) return error;
  error = file.Write(content);
  // A full disk may be reported only here.
  if (error == 0) error = file.Sync();
  const int close_error = file.Close();
  if (error == 0) error = close_error;
  if (error == 0 && std::rename(temporary.c_str(), path.c_str()) != 0) {
    error = errno;
  }
  if (error != 0) unlink(temporary.c_str());
  return error;
}

// Says whether a link is the system's, such as /dev/stdout and /dev/fd/3.
bool IsSystemLink(const fs::path& path) {
  std::error_code unknown;
  const fs::path folder = fs::canonical(path.parent_path(), unknown);
  if (unknown || folder.empty()) return false;
  const auto root = std::next(folder.begin());
  return root != folder.end() && (*root == "dev" || *root == "proc");
}

int WriteFile(const std::string& path, const std::string& content) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (fs::is_directory(status)) return EISDIR;
  if (fs::exists(status) && !fs::is_regular_file(status)) {
    return WriteThrough(path, content);
  }
  if (!fs::is_symlink(fs::symlink_status(path, error)) || !IsSystemLink(path)) {
    return WriteAndRename(path, content);
  }
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
  fs::create_directories(path, error);
  if (error || !fs::is_directory(path)) {
    throw InputError(path + ": cannot be made a folder: " +
                     (error ? error.message() : "a file has that name"));
  }
}

void RefuseFolderOrPipe(const std::string& path, const std::string& expected) {
  std::error_code unknown;
  const fs::file_status status = fs::status(path, unknown);
  if (fs::is_directory(status)) {
    throw InputError(path + ": is a folder, expected " + expected);
  }
  if (fs::is_fifo(status)) {
    throw InputError(path + ": is a pipe, expected " + expected +
                     "; inputs are read more than once");
  }
}

void RefuseUnwritable(const std::string& path) {
  std::error_code unknown;
  if (fs::is_directory(path, unknown)) {
    throw InputError(path + ": is a folder, expected a file to write");
  }
  const std::string folder = fs::path(path).parent_path().string();
  if (access(folder.empty() ? "." : folder.c_str(), W_OK | X_OK) != 0) {
    throw InputError(path + ": cannot be written: " + std::strerror(errno));
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

int FileDescriptor::Open(const std::string& path, int flags) {
  Close();
  file_ = open(path.c_str(), flags | O_CLOEXEC, 0666);
  return file_ < 0 ? errno : 0;
}

int FileDescriptor::Write(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t n = write(file_, bytes.data(), bytes.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return errno;
    bytes.remove_prefix(static_cast<std::size_t>(n));
  }
  return 0;
}

int FileDescriptor::Truncate(std::uint64_t bytes) {
  const auto offset = static_cast<off_t>(bytes);
  if (ftruncate(file_, offset) != 0) return errno;
  return lseek(file_, offset, SEEK_SET) < 0 ? errno : 0;
}

int FileDescriptor::Sync() { return fsync(file_) == 0 ? 0 : errno; }

int FileDescriptor::Close() {
  if (file_ < 0) return 0;
  const int result = close(file_);
  file_ = -1;
  return result == 0 ? 0 : errno;
}

int SyncFolder(const std::string& path) {
  FileDescriptor folder;
  const int error = folder.Open(path.empty() ? "." : path, O_RDONLY);
  return error != 0 ? error : folder.Sync();
}

}  // namespace finray
