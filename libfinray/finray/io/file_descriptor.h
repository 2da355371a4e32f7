#ifndef FINRAY_IO_FILE_DESCRIPTOR_H_
#define FINRAY_IO_FILE_DESCRIPTOR_H_

#include <cstdint>
#include <string>
#include <string_view>

namespace finray {

/// An open file, closed with its owner. Its functions return 0 or what went
/// wrong as an errno value.
class FileDescriptor {
 public:
  FileDescriptor() = default;
  ~FileDescriptor() { Close(); }
  FileDescriptor(const FileDescriptor&) = delete;
  FileDescriptor& operator=(const FileDescriptor&) = delete;

  /// Flags are those of open(2). A new file may be read by all, as far as the
  /// umask lets them.
  int Open(const std::string& path, int flags);
  /// Writes all bytes where the last ones ended.
  int Write(std::string_view bytes);
  /// All that is left to read.
  int ReadAll(std::string* bytes);
  /// Cuts the file to its first `bytes`, and goes on writing behind them.
  int Truncate(std::uint64_t bytes);
  /// Returns once the bytes are on the disk.
  int Sync();
  int Close();

  /// The number that system calls take; -1 if none is open.
  int get() const { return file_; }

 private:
  int file_ = -1;
};

/// Makes what was renamed in a folder, or removed from it, safe.
int SyncFolder(const std::string& path);

}  // namespace finray

#endif  // FINRAY_IO_FILE_DESCRIPTOR_H_
