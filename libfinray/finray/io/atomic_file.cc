#include "finray/io/atomic_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include "finray/io/error.h"
#include "finray/io/file_descriptor.h"

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

// Creates a new file in the folder. mkstemp would let only the owner read it.
int CreateTemporary(const fs::path& folder, fs::path* path,
                    FileDescriptor* file) {
  static std::atomic<unsigned> counter{0};
  int error = 0;
  do {
    *path = folder / (".finray-" + std::to_string(getpid()) + "-" +
                      std::to_string(counter++) + ".tmp");
    error = file->Open(*path, O_WRONLY | O_CREAT | O_EXCL);
  } while (error == EEXIST);
  return error;
}

int WriteAndRename(const fs::path& path, const std::string& content) {
  fs::path temporary;
  FileDescriptor file;
  int error = CreateTemporary(path.parent_path(), &temporary, &file);
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

}  // namespace finray
