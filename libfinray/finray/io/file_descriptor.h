#ifndef FINRAY_IO_FILE_DESCRIPTOR_H_
#define FINRAY_IO_FILE_DESCRIPTOR_H_

#include <cstdint>
#include <string>
#include <string_view>

namespace finray {

/// An open file that its destructor closes. The functions return 0 or an errno
/// value.
class FileDescriptor {
 public:
  FileDescriptor() = default;
  ~FileDescriptor() { Close(); }
  FileDescriptor(const FileDescriptor&) = delete;
  FileDescriptor& operator=(const FileDescriptor&) = delete;

  /// `flags` are those of open(2). All users may read a new file, within the
  /// umask.
  int Open(const std::string& path, int flags);
  /// Writes all bytes behind those that were written before.
  int Write(std::string_view bytes);
  /// Reads the rest of the file.
  int ReadAll(std::string* bytes);
  /// Cuts the file to its first `bytes`; the next write goes behind them.
  int Truncate(std::uint64_t bytes);
  /// Returns once the bytes are on the disk.
  int Sync();
  int Close();

  /// The descriptor for system calls; -1 if no file is open.
  int get() const { return file_; }

 private:
  int file_ = -1;
};

/// Returns once renames and removals in a folder are on the disk.
int SyncFolder(const std::string& path);

}  // namespace finray

#endif  // FINRAY_IO_FILE_DESCRIPTOR_H_
