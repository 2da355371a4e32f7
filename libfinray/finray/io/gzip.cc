#include "finray/io/gzip.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <limits>
#include <stdexcept>

#include "finray/io/error.h"
#include "finray/io/input_file.h"

namespace finray {

GzipFile::GzipFile(const std::string& path) : path_(path) {
  RefuseFolderOrPipe(path, "a file");
  errno = 0;
  file_ = gzopen(path.c_str(), "rb");
  if (file_ == nullptr) {
    throw InputError(path + ": cannot be read: " + std::strerror(errno));
  }
  gzbuffer(file_, 1 << 17);
}

GzipFile::~GzipFile() { gzclose(file_); }

int GzipFile::Read(char* buffer, int size) {
  const int n = gzread(file_, buffer, static_cast<unsigned>(size));
  // A file that was cut short yields its bytes together with an error.
  int error = Z_OK;
  const char* message = gzerror(file_, &error);
  if (n < 0 || (error != Z_OK && error != Z_STREAM_END)) {
    const std::string reason =
        error == Z_ERRNO ? std::strerror(errno) : std::string(message);
    throw InputError(path_ + ": cannot be read to its end: " + reason);
  }
  return n;
}

std::string Gzipped(const std::string& content) {
  z_stream stream = {};
  // 15 + 16: the largest window, with a gzip header.
  if (deflateInit2(&stream, Z_DEFAULT_COMPRESSION, Z_DEFLATED, 15 + 16, 8,
                   Z_DEFAULT_STRATEGY) != Z_OK) {
    throw std::runtime_error("zlib cannot be started");
  }
  std::string zipped;
  std::string chunk(1 << 18, '\0');
  std::size_t done = 0;
  int state = Z_OK;
  while (state != Z_STREAM_END) {
    // zlib counts in 32 bits, and tables may be longer than that.
    constexpr std::size_t kMost = std::numeric_limits<uInt>::max();
    const std::size_t piece = std::min(content.size() - done, kMost);
    stream.next_in =
        reinterpret_cast<Bytef*>(const_cast<char*>(content.data() + done));
    stream.avail_in = static_cast<uInt>(piece);
    stream.next_out = reinterpret_cast<Bytef*>(chunk.data());
    stream.avail_out = static_cast<uInt>(chunk.size());
    state = deflate(&stream,
                    done + piece == content.size() ? Z_FINISH : Z_NO_FLUSH);
    done += piece - stream.avail_in;
    zipped.append(chunk, 0, chunk.size() - stream.avail_out);
  }
  deflateEnd(&stream);
  return zipped;
}

}  // namespace finray
