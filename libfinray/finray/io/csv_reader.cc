#include "finray/io/csv_reader.h"

#include <cstring>
#include <limits>  // csv.h needs it and does not include it

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
// it. NUL bytes are handed on as this one, which text does not contain either.
constexpr char kNulStandIn = '\x01';

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

bool CsvReader::NextLine() {
  const char* text = nullptr;
  try {
    do {
      text = lines_->reader.next_line();
      if (text == nullptr) return false;
      line_ = text;
      line_number_ = static_cast<int>(lines_->reader.get_file_line());
      // One is gone already; "\r\r\n" comes from careless conversions.
      if (!line_.empty() && line_.back() == '\r') line_.remove_suffix(1);
    } while (Trimmed(line_).empty());
  } catch (const io::error::base&) {
    ++line_number_;
    Fail("the line is too long for a table of numbers");
  }
  return true;
}

void CsvReader::Split() {
  const std::string error = cells_.Split(line_);
  if (!error.empty()) FailAt(cells().size() - 1, error);
}

bool CsvReader::NextHeader() {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  do {
    if (!NextLine()) return false;
    // The line reader skips one at the start of the file only; files put
    // together from others have them behind their comments too.
    while (line_.substr(0, kByteOrderMark.size()) == kByteOrderMark) {
      line_.remove_prefix(kByteOrderMark.size());
    }
    line_ = Trimmed(line_);
  } while (line_.empty() || line_.front() == '#');
  Split();
  return true;
}

bool CsvReader::NextRow() {
  if (!NextLine()) return false;
  Split();
  return true;
}

std::size_t CsvReader::FirstNul() const {
  std::size_t index = 0;
  if (!lines_->saw_nul) return cells().size();
  while (index < cells().size() &&
         cells()[index].find(kNulStandIn) == std::string_view::npos) {
    ++index;
  }
  return index;
}

void CsvReader::Fail(const std::string& message) const {
  throw InputError(path_ + ":" + std::to_string(line_number_) + ": " + message);
}

void CsvReader::FailAt(std::size_t index, const std::string& message) const {
  throw InputError(path_ + ":" + std::to_string(line_number_) + ":" +
                   std::to_string(index + 1) + ": " + message);
}

}  // namespace finray
