#ifndef FINRAY_IO_FRAME_READER_H_
#define FINRAY_IO_FRAME_READER_H_

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "finray/io/frame_parser.h"
#include "finray/io/frame_table.h"
#include "finray/io/line_reader.h"

namespace finray {

/// Consecutive lines of a file, copied so that another thread can parse them
/// while the reader goes on. Clear() keeps the memory.
class LineBlock {
 public:
  void Clear() {
    text_.clear();
    lines_.clear();
    error.clear();
  }
  void Add(const CsvLine& line) {
    text_ += line.text;
    lines_.push_back({text_.size(), line.number, line.nul});
  }

  std::size_t size() const { return lines_.size(); }
  CsvLine at(std::size_t i) const {
    const std::size_t begin = i == 0 ? 0 : lines_[i - 1].end;
    const Line& line = lines_[i];
    return {std::string_view(text_).substr(begin, line.end - begin),
            line.number, line.nul};
  }

  /// The error in the file behind these lines, or "".
  std::string error;

 private:
  struct Line {
    std::size_t end;
    int number;
    bool nul;
  };

  std::string text_;
  std::vector<Line> lines_;
};

/// Reads a frame table piece by piece, so that its memory does not grow with
/// the length of the file.
class FrameReader {
 public:
  /// Opens .csv or .csv.gz and reads the header. `renames` and errors are those
  /// of FrameTable::Read. A file without rows is an error.
  explicit FrameReader(const std::string& path,
                       const std::map<std::string, std::string>& renames = {});

  /// Reads the next rows as lines, which parser() parses. It does not throw:
  /// the block holds the good lines and then the error. Returns false if the
  /// block holds neither.
  bool ReadLines(std::size_t rows, LineBlock* block);

  /// Skips rows without parsing them. Returns their number, which is less than
  /// `rows` only at the end of the file.
  std::size_t Skip(std::size_t rows);

  const FrameParser& parser() const { return parser_; }
  /// The number of rows that were read or skipped so far.
  std::size_t position() const { return position_; }

 private:
  friend class FrameTable;  // its Read() needs no copies of the lines

  bool NextRow();

  LineReader reader_;
  FrameParser parser_;
  std::size_t position_ = 0;
  bool looked_ahead_ = false;  // the reader's line is a row not yet returned
};

}  // namespace finray

#endif  // FINRAY_IO_FRAME_READER_H_
