#include "finray/io/line_reader.h"

#include <poll.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <memory>
#include <system_error>
#include <utility>

#include "finray/io/atomic_file.h"
#include "finray/io/csv_cells.h"
#include "finray/io/error.h"

namespace finray {
namespace {

constexpr std::size_t kFirstBuffer = 1 << 17;
constexpr std::size_t kLongestLine = 1 << 24;
// A gzipped file may unpack to kLeastUnpacked bytes and kUnpackedRatio times
// its size. Readings pack to a tenth at best where a gauge is dead, and a file
// that is made to exhaust the memory packs to a thousandth.
// scripts/common/limits.py has the same limit for other formats;
// tests/import/limits_test.py ties them.
constexpr std::uintmax_t kLeastUnpacked = 32 << 20, kUnpackedRatio = 32;

}  // namespace

LineReader::LineReader(ByteSource bytes, const std::string& name)
    : bytes_(std::move(bytes)), name_(name), buffer_(kFirstBuffer) {}

bool LineReader::Next() {
  do {
    while (!Take()) {
      if (ended_ || !Fill()) return false;
    }
  } while (IsBlank());
  return true;
}

bool LineReader::IsBlank() const {
  return Trimmed(line_.text).empty() &&
         !(keep_tabs_ && line_.text.find('\t') != line_.text.npos);
}

bool LineReader::Take() {
  const char* start = buffer_.data() + begin_;
  const auto* line_end = static_cast<const char*>(
      std::memchr(buffer_.data() + searched_, '\n', end_ - searched_));
  searched_ = end_;
  if (line_end == nullptr) {
    if (!ended_ || begin_ == end_) return false;
    line_end = buffer_.data() + end_;  // the last line has no end of its own
  }
  line_.text = {start, static_cast<std::size_t>(line_end - start)};
  begin_ = std::min(begin_ + line_.text.size() + 1, end_);
  searched_ = begin_;
  // Careless conversions write "\r\r\n".
  while (!line_.text.empty() && line_.text.back() == '\r') {
    line_.text.remove_suffix(1);
  }
  line_.nul = line_.text.find('\0') != std::string_view::npos;
  ++line_.number;
  return true;
}

bool LineReader::Fill() {
  if (begin_ > 0) {
    std::memmove(buffer_.data(), buffer_.data() + begin_, end_ - begin_);
    end_ -= begin_;
    searched_ -= begin_;
    begin_ = 0;
  }
  if (end_ == buffer_.size()) {
    if (end_ >= kLongestLine) {
      throw InputError(name_ + ":" + std::to_string(line_.number + 1) +
                       ": the line is too long for a table of numbers");
    }
    buffer_.resize(2 * end_);
  }
  const int count =
      bytes_(buffer_.data() + end_, static_cast<int>(buffer_.size() - end_));
  if (count < 0) return false;
  ended_ = count == 0;
  end_ += static_cast<std::size_t>(count);
  return true;
}

LineReader ReadFile(const std::string& path) {
  RefuseFolderOrPipe(path, "a file");
  errno = 0;
  const gzFile opened = gzopen(path.c_str(), "rb");
  if (opened == nullptr) {
    throw InputError(path + ": cannot be read: " + std::strerror(errno));
  }
  const std::shared_ptr<gzFile_s> file(opened, gzclose);
  gzbuffer(opened, 1 << 17);
  std::error_code unknown;
  const std::uintmax_t packed = std::filesystem::file_size(path, unknown);
  std::uintmax_t left =
      kLeastUnpacked + kUnpackedRatio * (unknown ? 0 : packed);
  const auto read = [path, file, left](char* buffer, int size) mutable {
    const int n = gzread(file.get(), buffer, static_cast<unsigned>(size));
    if (n > 0 && gzdirect(file.get()) == 0) {
      if (static_cast<std::uintmax_t>(n) > left) {
        throw InputError(path + ": unpacks to more than " +
                         std::to_string(kLeastUnpacked >> 20) + " MiB and " +
                         std::to_string(kUnpackedRatio) +
                         " times its size, which no log does; if this is one, "
                         "unpack it before");
      }
      left -= static_cast<std::uintmax_t>(n);
    }
    // A file that was cut short yields its bytes together with an error.
    int error = Z_OK;
    const char* message = gzerror(file.get(), &error);
    if (n < 0 || (error != Z_OK && error != Z_STREAM_END)) {
      const std::string reason =
          error == Z_ERRNO ? std::strerror(errno) : std::string(message);
      throw InputError(path + ": cannot be read to its end: " + reason);
    }
    return n;
  };
  return LineReader(read, path);
}

ByteSource PipeBytes(int file, int wake, const std::string& name) {
  return [file, wake, name](char* buffer, int size) {
    pollfd waiting[2] = {{file, POLLIN, 0}, {wake, POLLIN, 0}};
    while (poll(waiting, 2, -1) < 0) {
      if (errno != EINTR) break;  // read() reports the error
    }
    if (wake >= 0 && waiting[1].revents != 0) return -1;
    ssize_t count;
    do {
      count = read(file, buffer, static_cast<std::size_t>(size));
    } while (count < 0 && errno == EINTR);
    if (count < 0) {
      throw InputError(name + ": cannot be read: " + std::strerror(errno));
    }
    return static_cast<int>(count);
  };
}

LineReader ReadPipe(int file, int wake, const std::string& name) {
  return LineReader(PipeBytes(file, wake, name), name);
}

}  // namespace finray
