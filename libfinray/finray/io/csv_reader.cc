#include "finray/io/csv_reader.h"

#include <cstring>
#include <limits>  // csv.h needs it and does not include it

#include "finray/io/csv_cells.h"
#include "finray/io/error.h"
#include "finray/io/gzip.h"

// Files are parsed far slower than they are read: a thread would not pay.
#define CSV_IO_NO_THREAD
// The library cuts long file names short on purpose.
#pragma GCC diagnostic ignored "-Wstringop-truncation"
#include <libfccp/csv.h>

namespace finray {
namespace {

// The line reader takes NUL for the end of a line, which would hide the rest of
// it. NUL bytes are handed on as kNulStandIn, which text does not contain
// either.
class Source : public io::ByteSourceBase {
 public:
  Source(const std::string& path, bool* saw_nul)
      : file_(path), saw_nul_(saw_nul) {}

  int read(char* buffer, int size) override {
    int n = file_.Read(buffer, size);
    for (char* at = buffer;
         (at = static_cast<char*>(std::memchr(at, 0, buffer + n - at)));) {
      *at = kNulStandIn;
      *saw_nul_ = true;
    }
    if (n > 0) last_ = buffer[n - 1];
    // Without a line end at its end, the line reader may run on into what an
    // earlier block left in its buffer.
    if (n < size && last_ != '\n') buffer[n++] = last_ = '\n';
    return n;
  }

 private:
  GzipFile file_;
  char last_ = '\n';
  bool* saw_nul_;
};

}  // namespace

struct CsvReader::Lines {
  explicit Lines(const std::string& path)
      : reader(path, std::make_unique<Source>(path, &saw_nul)) {}

  // Not in the source, which the reader drops once it has a small file whole.
  bool saw_nul = false;
  io::LineReader reader;
};

CsvReader::CsvReader(const std::string& path)
    : path_(path), lines_(std::make_unique<Lines>(path)) {}

CsvReader::~CsvReader() = default;

bool CsvReader::Next() {
  try {
    do {
      const char* text = lines_->reader.next_line();
      if (text == nullptr) return false;
      line_.text = text;
      line_.number = static_cast<int>(lines_->reader.get_file_line());
      // One is gone already; "\r\r\n" comes from careless conversions.
      if (!line_.text.empty() && line_.text.back() == '\r') {
        line_.text.remove_suffix(1);
      }
    } while (Trimmed(line_.text).empty());
  } catch (const io::error::base&) {
    throw InputError(path_ + ":" + std::to_string(line_.number + 1) +
                     ": the line is too long for a table of numbers");
  }
  line_.nul = lines_->saw_nul;
  return true;
}

}  // namespace finray
