#ifndef FINRAY_IO_ATOMIC_FILE_H_
#define FINRAY_IO_ATOMIC_FILE_H_

#include <cstdint>
#include <string>
#include <string_view>

namespace finray {

/// Writes the content under a temporary name in the same folder and renames the
/// file, so that `path` never holds a partial file. On failure it removes the
/// temporary file and throws InputError with the cause. A link to a file is
/// replaced and its target stays as it is, as somebody else may have put it
/// there; only those of the system (/dev/stdout) are followed. A device or pipe
/// cannot be replaced and is written to directly.
void WriteFileAtomically(const std::string& path, const std::string& content);

/// Creates a folder and its parents. Throws InputError if that fails.
void MakeFolder(const std::string& path);

/// Throws InputError for a folder and for a pipe. A pipe could block for ever
/// and cannot be read twice. `expected` is the kind of file in the message ("a
/// YAML file"). It does not check whether the file can be opened.
void RefuseFolderOrPipe(const std::string& path, const std::string& expected);

/// Throws InputError if `path` is a folder or its folder takes no file: for an
/// output that another program writes.
void RefuseUnwritable(const std::string& path);

/// Returns the bytes of a file. Throws InputError if it cannot be read, is a
/// folder or a pipe, or is longer than `most_MiB`.
std::string ReadWholeFile(const std::string& path, const std::string& expected,
                          int most_MiB);

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

#endif  // FINRAY_IO_ATOMIC_FILE_H_
