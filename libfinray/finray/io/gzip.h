#ifndef FINRAY_IO_GZIP_H_
#define FINRAY_IO_GZIP_H_

#include <zlib.h>

#include <string>

#include "finray/io/line_reader.h"

namespace finray {

/// The bytes of a file, unzipped if the file is gzipped.
class GzipFile : public ByteSource {
 public:
  /// Throws InputError if the file cannot be read or is a folder.
  explicit GzipFile(const std::string& path);
  ~GzipFile() override;
  GzipFile(const GzipFile&) = delete;
  GzipFile& operator=(const GzipFile&) = delete;

  /// Returns fewer bytes than `size` only at the end of the file. Throws
  /// InputError if the file is damaged or cut short.
  int Read(char* buffer, int size) override;

 private:
  std::string path_;
  gzFile file_;
};

/// Returns the gzipped content.
std::string Gzipped(const std::string& content);

}  // namespace finray

#endif  // FINRAY_IO_GZIP_H_
