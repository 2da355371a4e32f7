#ifndef FINRAY_IO_FRAME_PARSER_H_
#define FINRAY_IO_FRAME_PARSER_H_

#include <cstddef>
#include <deque>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "finray/io/line_reader.h"
#include "finray/io/nan.h"

namespace finray {

/// Rows of a frame table, cell by cell. Clear() keeps the memory.
class FrameRows {
 public:
  struct Cell {
    /// The number is NaN for text and for a cell that was not measured.
    double number = kNaN;
    /// The text has no quotes. It refers to the line that was parsed.
    std::string_view text;
  };

  void Clear() {
    rows_ = 0;
    cells_.clear();
    unquoted_.clear();
  }
  std::size_t rows() const { return rows_; }
  const Cell& at(std::size_t row, std::size_t column) const {
    return cells_[row * columns_ + column];
  }

 private:
  friend class FrameParser;

  // Appends an empty row and returns its first cell.
  Cell* AddRow(std::size_t columns) {
    columns_ = columns;
    ++rows_;
    cells_.resize(rows_ * columns);
    return &cells_[(rows_ - 1) * columns];
  }

  std::size_t rows_ = 0, columns_ = 0;
  std::vector<Cell> cells_;
  std::vector<std::string_view> split_;  // the line that is being read
  std::deque<std::string> unquoted_;     // a deque does not move its strings
};

/// Says whether a line is the header of a frame table, not a '#' comment or
/// blank. Removes byte order marks from the front of the line. Files that were
/// put together from others have such marks behind comments too.
bool IsHeaderLine(CsvLine* line);

/// Parses the rows of a frame table by its header. Several threads may use one.
class FrameParser {
 public:
  /// `renames` maps a lab's own headers to vocabulary names, or the other way
  /// round if only the key is a vocabulary name. Throws InputError
  /// (path:line:column) for a bad header.
  FrameParser(const std::string& path, const CsvLine& header,
              const std::map<std::string, std::string>& renames);

  const std::string& path() const { return path_; }
  const std::vector<std::string>& names() const { return names_; }
  /// Says whether a column holds numbers. Other columns hold text.
  bool IsNumeric(std::size_t column) const { return numeric_[column]; }

  /// Appends a line as a row. Throws InputError (path:line:column) for a wrong
  /// number of cells or a cell that is no number. The row then holds the cells
  /// before it.
  void Parse(const CsvLine& line, FrameRows* rows) const;

 private:
  [[noreturn]] void Fail(int line, const std::string& message) const;
  [[noreturn]] void FailAt(int line, std::size_t cell,
                           const std::string& message) const;

  std::string path_;
  std::vector<std::string> names_;
  std::vector<char> numeric_;
};

}  // namespace finray

#endif  // FINRAY_IO_FRAME_PARSER_H_
