#ifndef FINRAY_IO_GZIP_H_
#define FINRAY_IO_GZIP_H_

#include <zlib.h>

#include <string>

namespace finray {

/// The bytes of a file, unzipped if it is gzipped; others come as they are.
class GzipFile {
 public:
  /// Throws InputError if the file cannot be read or is a folder.
  explicit GzipFile(const std::string& path);
  ~GzipFile();
  GzipFile(const GzipFile&) = delete;
  GzipFile& operator=(const GzipFile&) = delete;

  /// Fills the buffer; fewer bytes than `size` only at the end of the file.
  /// Throws InputError if the file is damaged or cut short.
  int Read(char* buffer, int size);

 private:
  std::string path_;
  gzFile file_;
};

/// The content gzipped.
std::string Gzipped(const std::string& content);

}  // namespace finray

#endif  // FINRAY_IO_GZIP_H_
