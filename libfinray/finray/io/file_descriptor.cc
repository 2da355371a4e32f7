#include "finray/io/file_descriptor.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>

namespace finray {

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

int FileDescriptor::ReadAll(std::string* bytes) {
  bytes->clear();
  char buffer[1 << 14];
  for (;;) {
    const ssize_t n = read(file_, buffer, sizeof buffer);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return errno;
    if (n == 0) return 0;
    bytes->append(buffer, static_cast<std::size_t>(n));
  }
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
