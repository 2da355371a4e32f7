#ifndef FINRAY_IO_LINE_BLOCK_H_
#define FINRAY_IO_LINE_BLOCK_H_

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "finray/io/line_reader.h"

namespace finray {

/// Consecutive lines of a file, copied so that the reader can go on. Clear()
/// keeps the memory.
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
  std::size_t bytes() const { return text_.size(); }
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

}  // namespace finray

#endif  // FINRAY_IO_LINE_BLOCK_H_
